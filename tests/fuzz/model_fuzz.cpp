#include <cstddef>
#include <cstdint>

#include "tests/fuzz/model_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)pixelflex::testing::readModel({data, size});
  return 0;
}
