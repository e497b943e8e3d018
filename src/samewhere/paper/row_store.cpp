#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/paper/row_store.hpp>

namespace samewhere::paper {
namespace {

// Goes up when the same settings give other rows, or rows of another form.
constexpr const char* kRowVersion = "1";

std::string fingerprint(const std::string& settings) {
  return fmt::format("{:016x}", core::checksum(std::string(kRowVersion) + "\n" + settings));
}

}  // namespace

RowStore::RowStore(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) core::make_writable_folder(folder_);
}

std::filesystem::path RowStore::file_of(const std::string& name) const {
  return folder_ / (name + ".json");
}

std::optional<nlohmann::json> RowStore::find(const std::string& name,
                                             const std::string& settings) const {
  if (folder_.empty() || !core::is_there(file_of(name))) return std::nullopt;
  const nlohmann::json file =
      nlohmann::json::parse(core::read_file(file_of(name)), nullptr, /*allow_exceptions=*/false);
  if (!file.is_object() || file.value("fingerprint", "") != fingerprint(settings) ||
      !file.contains("rows"))
    return std::nullopt;
  return file.at("rows");
}

void RowStore::keep(const std::string& name, const std::string& settings,
                    const nlohmann::json& rows) const {
  if (folder_.empty()) return;
  const nlohmann::json file = {
      {"fingerprint", fingerprint(settings)}, {"settings", settings}, {"rows", rows}};
  core::write_file(file_of(name), file.dump(1) + "\n");
}

}  // namespace samewhere::paper
