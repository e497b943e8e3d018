#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include <samewhere/core/config.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/paper/row_store.hpp>

namespace samewhere::paper {
namespace {

// Goes up when the same settings give other rows, or rows of another form.
constexpr int kRowVersion = 2;

void add_settings(const YAML::Node& node, const std::string& path, RowSettings& settings) {
  if (!node.IsMap()) {
    settings[path] = node.IsScalar() ? node.Scalar() : YAML::Dump(node);
    return;
  }
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>();
    add_settings(entry.second, path.empty() ? name : path + "." + name, settings);
  }
}

}  // namespace

RowSettings settings_of(const pipeline::Config& config) {
  RowSettings settings;
  add_settings(YAML::Load(core::config_as_yaml(config)), "", settings);
  return settings;
}

RowStore::RowStore(std::filesystem::path folder, bool is_fresh)
    : folder_(std::move(folder)), is_fresh_(is_fresh), defaults_(settings_of(pipeline::Config())) {
  if (!folder_.empty()) core::make_writable_folder(folder_);
}

std::filesystem::path RowStore::file_of(const std::string& name) const {
  return folder_ / (name + ".json");
}

bool RowStore::are_same(const RowSettings& kept, const RowSettings& settings) const {
  const auto is_known_and_same = [&](const auto& setting) {
    const auto now = settings.find(setting.first);
    return now != settings.end() && now->second == setting.second;
  };
  const auto is_known_or_default = [&](const auto& setting) {
    if (kept.contains(setting.first)) return true;
    const auto by_default = defaults_.find(setting.first);
    return by_default != defaults_.end() && by_default->second == setting.second;
  };
  return std::all_of(kept.begin(), kept.end(), is_known_and_same) &&
         std::all_of(settings.begin(), settings.end(), is_known_or_default);
}

std::optional<nlohmann::json> RowStore::find(const std::string& name,
                                             const RowSettings& settings) const {
  if (folder_.empty() || is_fresh_ || !core::is_there(file_of(name))) return std::nullopt;
  const nlohmann::json file =
      nlohmann::json::parse(core::read_file(file_of(name)), nullptr, /*allow_exceptions=*/false);
  if (!file.is_object() || file.value("version", 0) != kRowVersion || !file.contains("rows"))
    return std::nullopt;
  if (!are_same(file.value("settings", RowSettings()), settings)) return std::nullopt;
  return file.at("rows");
}

void RowStore::keep(const std::string& name, const RowSettings& settings,
                    const nlohmann::json& rows) const {
  if (folder_.empty()) return;
  const nlohmann::json file = {{"version", kRowVersion}, {"settings", settings}, {"rows", rows}};
  core::write_file(file_of(name), file.dump(1) + "\n");
}

}  // namespace samewhere::paper
