#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace samewhere::core {

// What a person must know about a setting beside its name and default.
struct FieldInfo {
  std::string_view help;  // meaning and unit, half a line
  std::optional<double> min = std::nullopt;
  std::optional<double> max = std::nullopt;
  std::vector<std::string_view> choices = {};  // names of an enum's values, in their order
  bool is_expert = false;
};

// Walks over the fields of a config struct. Every folder with settings has a `struct Config` and
// beside it
//
//   void visit_fields(Config& config, core::FieldVisitor& visit) {
//     visit("min_similarity", config.min_similarity, {.help = "cosine", .min = -1.0, .max = 1.0});
//   }
//
// This one list drives the YAML reader, the YAML writer, the docs table and --set. Fields: bool,
// int, double, std::string, an enum counting from 0 (with `choices`), or a struct that has
// visit_fields itself (a section).
class FieldVisitor {
 public:
  FieldVisitor() = default;
  FieldVisitor(const FieldVisitor&) = delete;
  FieldVisitor& operator=(const FieldVisitor&) = delete;
  virtual ~FieldVisitor() = default;

  template <class T>
  void operator()(std::string_view name, T& field, const FieldInfo& info) {
    if constexpr (std::is_enum_v<T>) {
      int chosen = static_cast<int>(field);
      choice(name, chosen, info);
      field = static_cast<T>(chosen);
    } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
      if (!enter(name, info)) return;
      visit_fields(field, *this);
      leave();
    } else {
      value(name, field, info);
    }
  }

 protected:
  virtual void value(std::string_view name, bool& field, const FieldInfo& info) = 0;
  virtual void value(std::string_view name, int& field, const FieldInfo& info) = 0;
  virtual void value(std::string_view name, double& field, const FieldInfo& info) = 0;
  virtual void value(std::string_view name, std::string& field, const FieldInfo& info) = 0;
  virtual void choice(std::string_view name, int& field, const FieldInfo& info) = 0;
  // False: the section is skipped, leave() is not called.
  virtual bool enter(std::string_view name, const FieldInfo& info) = 0;
  virtual void leave() = 0;
};

// A config struct of any type, seen as its fields.
using FieldWalk = void (*)(void* config, FieldVisitor& visit);

// Fields named in the YAML text take its values, the others keep theirs. Throws InputError naming
// key, value, `origin` (the file) and line on an unknown key, a value of the wrong type or outside
// its range, or text that is no YAML.
void read_fields(void* config, FieldWalk walk, const std::string& yaml, const std::string& origin);
// `assignment` is "section.key=value", `origin` what the user typed. Throws InputError as
// read_fields.
void assign_field(void* config, FieldWalk walk, const std::string& assignment,
                  const std::string& origin);
std::string fields_as_yaml(void* config, FieldWalk walk, bool with_help);
std::string fields_as_table(void* config, FieldWalk walk);

template <class Config>
void walk_fields(void* config, FieldVisitor& visit) {
  visit_fields(*static_cast<Config*>(config), visit);
}

template <class Config>
void read_config(Config& config, const std::string& yaml, const std::string& origin) {
  Config changed = config;  // an error leaves `config` as it was
  read_fields(&changed, &walk_fields<Config>, yaml, origin);
  config = changed;
}

template <class Config>
void set_config(Config& config, const std::string& assignment, const std::string& origin) {
  Config changed = config;
  assign_field(&changed, &walk_fields<Config>, assignment, origin);
  config = changed;
}

// As an option --set gives it.
template <class Config>
void set_config(Config& config, const std::string& assignment) {
  set_config(config, assignment, "--set " + assignment);
}

// YAML that read_config reads back to the same values; with_help adds meaning and range as
// comments.
template <class Config>
std::string config_as_yaml(Config config, bool with_help = false) {
  return fields_as_yaml(&config, &walk_fields<Config>, with_help);
}

// Markdown: one table per section with key, default, range and meaning.
template <class Config>
std::string config_as_table(Config config) {
  return fields_as_table(&config, &walk_fields<Config>);
}

}  // namespace samewhere::core
