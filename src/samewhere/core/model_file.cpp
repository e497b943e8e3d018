#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/model_file.hpp>

namespace samewhere::core {

std::filesystem::path find_model(const std::string& setting, const std::string& file,
                                 const std::string& expected) {
  const std::filesystem::path shipped = std::filesystem::path(SAMEWHERE_MODELS_FOLDER) / file;
  for (const std::filesystem::path& path : {std::filesystem::path(file), shipped}) {
    std::error_code ignored;  // what cannot be looked at is not there
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  throw InputError(fmt::format("{} = {}: there is no such file, here or in {}; expected {}",
                               setting, file.empty() ? "\"\"" : file, SAMEWHERE_MODELS_FOLDER,
                               expected));
}

}  // namespace samewhere::core
