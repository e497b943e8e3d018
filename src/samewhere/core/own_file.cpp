#include <dlfcn.h>

#include <samewhere/core/own_file.hpp>

namespace samewhere::core {

std::filesystem::path own_file() {
  static const int anchor = 0;
  Dl_info info{};
  std::error_code error;
  const bool is_known = dladdr(&anchor, &info) != 0 && info.dli_fname != nullptr;
  // a program is named as it was called
  const bool is_library = is_known && std::filesystem::path(info.dli_fname).is_absolute();
  return std::filesystem::canonical(is_library ? info.dli_fname : "/proc/self/exe", error);
}

}  // namespace samewhere::core
