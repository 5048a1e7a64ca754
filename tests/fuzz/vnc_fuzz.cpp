#include <cstddef>
#include <cstdint>

#include "tests/fuzz/vnc_entry.h"

// The largest desktops are refused for want of memory instead of slowing every run down.
extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier): the sanitizer's name
  return "max_allocation_size_mb=64:allocator_may_return_null=1";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)pixelflex::testing::hearServer({data, size});
  return 0;
}
