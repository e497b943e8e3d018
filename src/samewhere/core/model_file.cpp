#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/model_file.hpp>

namespace samewhere::core {

std::filesystem::path find_model(const std::string& setting, const std::string& file,
                                 const std::string& expected) {
  const std::filesystem::path shipped = std::filesystem::path(SAMEWHERE_MODELS_FOLDER) / file;
  const bool is_path = file.find('/') != std::string::npos;
  const bool is_shipped = !file.empty() && !is_path && is_there(shipped);
  std::error_code ignored;  // what cannot be looked at is not confused
  if (is_shipped && std::filesystem::exists(file, ignored) &&
      !std::filesystem::equivalent(shipped, file, ignored)) {
    spdlog::warn(
        "{} = {}: the file {} is taken, which comes with the program, and not the one in "
        "the working directory; ./{} is that one",
        setting, file, shipped.string(), file);
  }
  if (is_shipped) return shipped;
  if (!file.empty() && is_there(file)) return file;
  throw InputError(fmt::format("{} = {}: there is no such file, here or in {}; expected {}",
                               setting, file.empty() ? "\"\"" : file, SAMEWHERE_MODELS_FOLDER,
                               expected));
}

}  // namespace samewhere::core
