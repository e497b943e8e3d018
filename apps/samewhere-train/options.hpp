#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <samewhere/core/config.hpp>

namespace samewhere::train {

// The option of a setting: of learning_rate --learning-rate.
inline std::string option_of(std::string setting) {
  std::replace(setting.begin(), setting.end(), '_', '-');
  return "--" + setting;
}

// One option for each setting, named by it. What was given is kept as text, so that the settings'
// own reader checks it.
class OptionMaker : public core::FieldVisitor {
 public:
  OptionMaker(CLI::App& app, std::map<std::string, std::string>& given)
      : app_(app), given_(given) {}

 protected:
  void value(std::string_view name, bool& field, const core::FieldInfo& info) override {
    add(name, field ? "true" : "false", info);
  }
  void value(std::string_view name, int& field, const core::FieldInfo& info) override {
    add(name, std::to_string(field), info);
  }
  void value(std::string_view name, double& field, const core::FieldInfo& info) override {
    add(name, fmt::format("{}", field), info);
  }
  void value(std::string_view name, std::string& field, const core::FieldInfo& info) override {
    add(name, field, info);
  }
  void choice(std::string_view name, int& field, const core::FieldInfo& info) override {
    add(name, std::string(info.choices[static_cast<std::size_t>(field)]), info);
  }
  bool enter(std::string_view /*name*/, const core::FieldInfo& /*info*/) override { return true; }
  void leave() override {}

 private:
  void add(std::string_view name, const std::string& usual, const core::FieldInfo& info) {
    const std::string choices =
        info.choices.empty() ? "" : fmt::format(" ({})", fmt::join(info.choices, ", "));
    const auto keep = [&given = given_, key = std::string(name)](const std::string& text) {
      given[key] = text;
    };
    app_.add_option_function<std::string>(option_of(std::string(name)), keep,
                                          std::string(info.help) + choices)
        ->default_str(usual);
  }

  CLI::App& app_;
  std::map<std::string, std::string>& given_;
};

// The options of all settings of a config; what was given is taken over by take().
template <class Config>
class SettingOptions {
 public:
  SettingOptions(CLI::App& app, Config& config) : config_(config) {
    OptionMaker make_options(app, given_);
    visit_fields(config, make_options);
  }

  void take() const {
    for (const auto& [key, text] : given_)
      core::set_config(config_, key + "=" + text, option_of(key) + " " + text);
  }

 private:
  Config& config_;
  std::map<std::string, std::string> given_;
};

// The command as it was typed, for the card.
std::string as_typed(int argc, char** argv);

// Takes the command line. The exit status if that is all there is to do: help was asked for, or
// something is wrong with it.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

// Throws InputError unless a network can be written there: what would be found out after hours.
void require_writable_network(const std::filesystem::path& out);

// How many threads learn; 0: one per processor.
void use_threads(int num_threads);

}  // namespace samewhere::train
