#include "viewer/vnc/jpeg_rect.h"

#include <csetjmp>
#include <cstdio>
// Needs <cstdio> before it.
#include <jpeglib.h>

namespace pixelflex::viewer {
namespace {

struct ErrorManager {
  jpeg_error_mgr functions{};  // first: libjpeg knows only this
  std::jmp_buf giveUp{};
};

[[noreturn]] void onError(j_common_ptr decoder) {
  std::longjmp(reinterpret_cast<ErrorManager*>(decoder->err)->giveUp, 1);
}

void onMessage(j_common_ptr, int) {}

// Between here and the caller's setjmp nothing needs a destructor: an error jumps over it.
bool decode(jpeg_decompress_struct& decoder, devices::Size size, std::uint8_t* out, std::size_t rowBytes) {
  jpeg_read_header(&decoder, TRUE);
  const bool fits = decoder.image_width == static_cast<JDIMENSION>(size.width) &&
                    decoder.image_height == static_cast<JDIMENSION>(size.height);
  if (!fits) return false;
  decoder.out_color_space = JCS_EXT_RGBX;
  jpeg_start_decompress(&decoder);
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW row = out + decoder.output_scanline * rowBytes;
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  return true;
}

}  // namespace

bool decodeJpegRect(std::span<const std::uint8_t> jpeg, devices::Size size, std::uint8_t* out, std::size_t rowBytes) {
  ErrorManager errors;
  jpeg_decompress_struct decoder{};
  decoder.err = jpeg_std_error(&errors.functions);
  errors.functions.error_exit = onError;
  errors.functions.emit_message = onMessage;
  volatile bool decoded = false;  // kept across the jump
  if (setjmp(errors.giveUp) == 0) {
    jpeg_create_decompress(&decoder);
    jpeg_mem_src(&decoder, jpeg.data(), jpeg.size());
    decoded = decode(decoder, size, out, rowBytes);
  }
  jpeg_destroy_decompress(&decoder);
  return decoded;
}

}  // namespace pixelflex::viewer
