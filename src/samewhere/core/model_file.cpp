#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/model_file.hpp>
#include <samewhere/core/own_file.hpp>

namespace samewhere::core {

// An installed program may have been moved: its models are looked for under its prefix (bin/, lib/
// or lib/x86_64-linux-gnu/).
std::filesystem::path models_folder() {
  const std::filesystem::path folder = own_file().parent_path();
  for (const char* up : {"..", "../.."}) {
    std::error_code error;
    const auto models =
        std::filesystem::weakly_canonical(folder / up / "share" / "samewhere" / "models", error);
    if (!folder.empty() && !error && std::filesystem::is_directory(models, error)) return models;
  }
  return SAMEWHERE_MODELS_FOLDER;
}

std::filesystem::path find_model(const std::string& setting, const std::string& file,
                                 const std::string& expected) {
  const std::filesystem::path shipped = models_folder() / file;
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
                               setting, file.empty() ? "\"\"" : file, models_folder().string(),
                               expected));
}

}  // namespace samewhere::core
