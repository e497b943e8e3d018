#include <cstddef>
#include <cstdint>

#include "readers.hpp"

// The function that libFuzzer calls, with its name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samewhere::test::read_as_message({reinterpret_cast<const char*>(data), size});
  return 0;
}
