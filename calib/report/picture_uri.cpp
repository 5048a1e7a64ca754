#include "calib/report/picture_uri.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace pixelflex::calib {
namespace {

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned int group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = group << 8U | (j < count ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

std::string encoded(const cv::Mat& picture, const std::string& ending, const std::string& type,
                    const std::vector<int>& settings) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(ending, picture, bytes, settings)) throw std::runtime_error("a picture cannot be encoded");
  return "data:image/" + type + ";base64," + base64(bytes);
}

/// A view, not a copy; OpenCV has no read-only one.
cv::Mat viewOf(const devices::Image8& image) {
  auto* samples = const_cast<std::uint8_t*>(image.samples().data());
  return {image.height(), image.width(), CV_8UC(image.channels()), samples};
}

/// Code that only one pixel in 500 exceeds: where the picture's own white is.
int whiteOf(const cv::Mat& picture) {
  std::array<int, 256> histogram{};
  for (auto it = picture.begin<cv::Vec3b>(); it != picture.end<cv::Vec3b>(); ++it) {
    ++histogram[std::max({(*it)[0], (*it)[1], (*it)[2]})];
  }
  int above = static_cast<int>(picture.total()) / 500;
  int code = 255;
  while (code > 1 && (above -= histogram[static_cast<std::size_t>(code)]) >= 0) --code;
  return code;
}

void brighten(cv::Mat& picture) {
  constexpr double kLift = 0.7;  // photographs of light on a wall are mostly dark
  const double white = whiteOf(picture);
  cv::Mat codes(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i) {
    codes.at<unsigned char>(0, i) = static_cast<unsigned char>(255 * std::pow(std::min(1.0, i / white), kLift));
  }
  cv::LUT(picture, codes, picture);
}

}  // namespace

std::string photographUri(const devices::Image8& photo, const PixelBox& box, int width) {
  assert(photo.channels() == 3 && box.left >= 0 && box.top >= 0 && box.right <= photo.width() &&
         box.bottom <= photo.height() && box.width() > 0 && box.height() > 0);
  cv::Mat picture = viewOf(photo)(cv::Rect(box.left, box.top, box.width(), box.height())).clone();
  if (box.width() > width) {
    const int height = std::max(1, box.height() * width / box.width());
    cv::resize(picture, picture, {width, height}, 0, 0, cv::INTER_AREA);
  }
  brighten(picture);
  cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
  return encoded(picture, ".jpg", "jpeg", {cv::IMWRITE_JPEG_QUALITY, 80});
}

std::string jpegUri(const devices::Image8& picture) {
  assert(picture.channels() == 3);
  cv::Mat pixels;
  cv::cvtColor(viewOf(picture), pixels, cv::COLOR_RGB2BGR);
  return encoded(pixels, ".jpg", "jpeg", {cv::IMWRITE_JPEG_QUALITY, 88});
}

std::string pictureUri(const devices::Image8& picture) {
  cv::Mat pixels = viewOf(picture).clone();
  if (picture.channels() == 4) cv::cvtColor(pixels, pixels, cv::COLOR_RGBA2BGRA);
  return encoded(pixels, ".png", "png", {cv::IMWRITE_PNG_COMPRESSION, 9});
}

}  // namespace pixelflex::calib
