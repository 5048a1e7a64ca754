#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/fuzz/store_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pixelflex::testing::readAsEveryStoreFile(std::string(data, data + size));
  return 0;
}
