#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <samewhere/core/config.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::core {
namespace {

std::string joined(const std::vector<std::string_view>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string range_text(const FieldInfo& info) {
  if (!info.choices.empty()) return joined(info.choices);
  if (info.min && info.max) return fmt::format("[{}, {}]", *info.min, *info.max);
  if (info.min) return fmt::format(">= {}", *info.min);
  if (info.max) return fmt::format("<= {}", *info.max);
  return "";
}

std::string in_quotes(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

// A double that reads back to itself and never looks like an integer.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

// Keeps track of the dotted path of sections.
class PathVisitor : public FieldVisitor {
 protected:
  std::string path(std::string_view name) const {
    std::string text;
    for (const auto& section : sections_) text += section + ".";
    return text + std::string(name);
  }

  std::vector<std::string> sections_;
};

class Reader : public PathVisitor {
 public:
  Reader(YAML::Node root, std::string origin) : origin_(std::move(origin)) {
    nodes_.push_back(std::move(root));
    known_.emplace_back();
    check_is_map(nodes_.back(), "the configuration");
  }

  void finish() { check_keys(); }

  void renamed(std::string_view old_path, std::string_view path) override {
    renamed_.emplace(old_path, path);
  }

 protected:
  void value(std::string_view name, bool& field, const FieldInfo& /*info*/) override {
    const std::optional<std::string> text = scalar(name);
    if (!text) return;
    if (*text != "true" && *text != "false") fail(name, "is not one of true, false");
    field = *text == "true";
  }

  void value(std::string_view name, int& field, const FieldInfo& info) override {
    if (const auto text = scalar(name)) field = number<int>(name, *text, info, "a whole number");
  }

  void value(std::string_view name, double& field, const FieldInfo& info) override {
    if (const auto text = scalar(name)) field = number<double>(name, *text, info, "a number");
  }

  void value(std::string_view name, std::string& field, const FieldInfo& /*info*/) override {
    if (const auto text = scalar(name)) field = *text;
  }

  void choice(std::string_view name, int& field, const FieldInfo& info) override {
    const std::optional<std::string> text = scalar(name);
    if (!text) return;
    for (std::size_t i = 0; i < info.choices.size(); ++i) {
      if (info.choices[i] != *text) continue;
      field = static_cast<int>(i);
      return;
    }
    fail(name, "is not one of " + joined(info.choices));
  }

  bool enter(std::string_view name, const FieldInfo& /*info*/) override {
    known_.back().push_back(name);
    const YAML::Node node = child(name);
    if (!node.IsDefined() || node.IsNull()) return false;
    check_is_map(node, path(name));
    sections_.emplace_back(name);
    nodes_.push_back(node);
    known_.emplace_back();
    return true;
  }

  void leave() override {
    check_keys();
    sections_.pop_back();
    nodes_.pop_back();
    known_.pop_back();
  }

 private:
  // const access: operator[] of a mutable node would add the key that is asked for
  YAML::Node child(std::string_view name) const {
    const YAML::Node& node = nodes_.back();
    return node.IsMap() ? node[std::string(name)] : YAML::Node(YAML::NodeType::Undefined);
  }

  std::optional<std::string> scalar(std::string_view name) {
    known_.back().push_back(name);
    const YAML::Node node = child(name);
    if (!node.IsDefined()) return std::nullopt;
    if (!node.IsScalar()) throw InputError(path(name) + " must be a single value" + place(node));
    return node.Scalar();
  }

  template <class T>
  T number(std::string_view name, const std::string& text, const FieldInfo& info,
           const char* kind) {
    T parsed{};
    const char* const text_end = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), text_end, parsed);
    if (error == std::errc::result_out_of_range && end == text_end)
      fail(name, fmt::format("does not fit into {}", kind));
    if (error != std::errc{} || end != text_end || !std::isfinite(static_cast<double>(parsed)))
      fail(name, fmt::format("is not {}", kind));
    const auto as_double = static_cast<double>(parsed);
    const bool is_inside =
        as_double >= info.min.value_or(as_double) && as_double <= info.max.value_or(as_double);
    if (!is_inside) fail(name, "is outside " + range_text(info));
    return parsed;
  }

  [[noreturn]] void fail(std::string_view name, const std::string& what) const {
    const YAML::Node node = child(name);
    throw InputError(fmt::format("{} = {} {}{}", path(name), node.Scalar(), what, place(node)));
  }

  void check_is_map(const YAML::Node& node, const std::string& what) const {
    if (node.IsMap() || node.IsNull()) return;
    throw InputError(what + " must be a section with keys" + place(node));
  }

  // Every key of the section is known, and there once: the parser keeps both of a pair and finds
  // the first.
  void check_keys() const {
    if (!nodes_.back().IsMap()) return;
    std::set<std::string> seen;
    for (const auto& entry : nodes_.back()) {
      const std::string key = entry.first.Scalar();
      const auto& known = known_.back();
      if (std::find(known.begin(), known.end(), key) == known.end()) fail_unknown(entry.first);
      if (!seen.insert(key).second)
        throw InputError(path(key) + " is given twice" + place(entry.first));
    }
  }

  [[noreturn]] void fail_unknown(const YAML::Node& key) const {
    const std::string name = path(key.Scalar());
    const auto former = renamed_.find(name);
    if (former == renamed_.end())
      throw InputError(fmt::format("unknown key {}{}; expected one of: {}", name, place(key),
                                   joined(known_.back())));
    if (former->second.empty())
      throw InputError(fmt::format("{} is no setting any more{}", name, place(key)));
    throw InputError(fmt::format("{} is now {}{}", name, former->second, place(key)));
  }

  std::string place(const YAML::Node& node) const {
    if (node.Mark().is_null()) return "  (" + origin_ + ")";
    return fmt::format("  ({}, line {})", origin_, node.Mark().line + 1);
  }

  std::string origin_;
  std::vector<YAML::Node> nodes_;
  std::vector<std::vector<std::string_view>> known_;
  std::map<std::string, std::string, std::less<>> renamed_;  // old path to new, "" if removed
};

// Writes one line per field; derived classes say how.
class Lister : public PathVisitor {
 public:
  explicit Lister(Listed listed) : listed_(listed) {}

  const std::string& text() const { return text_; }

 protected:
  virtual void line(std::string_view name, const std::string& value, const FieldInfo& info) = 0;
  virtual void heading(std::string_view name, const FieldInfo& info) = 0;

  void value(std::string_view name, bool& field, const FieldInfo& info) override {
    list(name, field ? "true" : "false", info);
  }
  void value(std::string_view name, int& field, const FieldInfo& info) override {
    list(name, std::to_string(field), info);
  }
  void value(std::string_view name, double& field, const FieldInfo& info) override {
    list(name, number_text(field), info);
  }
  void value(std::string_view name, std::string& field, const FieldInfo& info) override {
    list(name, in_quotes(field), info);
  }
  void choice(std::string_view name, int& field, const FieldInfo& info) override {
    list(name, std::string(info.choices.at(static_cast<std::size_t>(field))), info);
  }

  // The heading is written with the section's first line: a section may have none that is listed.
  bool enter(std::string_view name, const FieldInfo& info) override {
    if (!info.is_used) return false;
    sections_.emplace_back(name);
    headings_.push_back({std::string(name), info, false});
    return true;
  }
  void leave() override {
    sections_.pop_back();
    headings_.pop_back();
  }

  std::string text_;

 private:
  struct Heading {
    std::string name;
    FieldInfo info;
    bool is_written = false;
  };

  void list(std::string_view name, const std::string& value, const FieldInfo& info) {
    bool is_expert = info.is_expert;
    for (const Heading& heading : headings_) is_expert |= heading.info.is_expert;
    if (listed_ == (is_expert ? Listed::kBasic : Listed::kExpert)) return;
    sections_.clear();  // as each heading is written, those above it are open
    for (Heading& heading : headings_) {
      if (!heading.is_written) this->heading(heading.name, heading.info);
      heading.is_written = true;
      sections_.push_back(heading.name);
    }
    line(name, value, info);
  }

  Listed listed_;
  std::vector<Heading> headings_;  // of the sections that are open
};

class YamlLister : public Lister {
 public:
  YamlLister(bool with_help, Listed listed) : Lister(listed), with_help_(with_help) {}

 protected:
  void line(std::string_view name, const std::string& value, const FieldInfo& info) override {
    std::string start = fmt::format("{}{}: {}", indent(), name, value);
    if (with_help_) {
      const std::string range = range_text(info);
      start = fmt::format("{:<36}  # {}{}", start, info.help, range.empty() ? "" : "; " + range);
    }
    text_ += start + "\n";
  }

  void heading(std::string_view name, const FieldInfo& info) override {
    if (with_help_) text_ += fmt::format("\n{}# {}\n", indent(), info.help);
    text_ += fmt::format("{}{}:\n", indent(), name);
  }

 private:
  std::string indent() const { return std::string(2 * sections_.size(), ' '); }

  bool with_help_;
};

class TableLister : public Lister {
 public:
  using Lister::Lister;

 protected:
  void line(std::string_view name, const std::string& value, const FieldInfo& info) override {
    if (!is_table_open_) text_ += "\n| key | default | range | meaning |\n|---|---|---|---|\n";
    is_table_open_ = true;
    text_ +=
        fmt::format("| `{}` | `{}` | {} | {} |\n", path(name), value, range_text(info), info.help);
  }

  void heading(std::string_view name, const FieldInfo& info) override {
    text_ += fmt::format("\n## {}\n\n{}.\n", path(name), info.help);
    is_table_open_ = false;
  }

 private:
  bool is_table_open_ = false;
};

YAML::Node parse(const std::string& yaml, const std::string& origin) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.size() > 1)
      throw InputError(origin + ": holds several YAML documents (a line ---), expected one");
    return documents.empty() ? YAML::Node(YAML::NodeType::Null) : documents.front();
  } catch (const YAML::ParserException& error) {
    throw InputError(
        fmt::format("{}, line {}: not YAML: {}", origin, error.mark.line + 1, error.msg));
  }
}

// "a.b" and "c" become {a: {b: c}}.
YAML::Node nested(const std::string& keys, const std::string& value) {
  YAML::Node section(YAML::NodeType::Map);
  const auto dot = keys.find('.');
  if (dot == std::string::npos) {
    section[keys] = value;
  } else {
    section[keys.substr(0, dot)] = nested(keys.substr(dot + 1), value);
  }
  return section;
}

}  // namespace

void read_fields(void* config, FieldWalk walk, const std::string& yaml, const std::string& origin) {
  Reader reader(parse(yaml, origin), origin);
  walk(config, reader);
  reader.finish();
}

void assign_field(void* config, FieldWalk walk, const std::string& assignment,
                  const std::string& origin) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || assignment.front() == '.') {
    throw InputError(origin + ": expected section.key=value");
  }
  Reader reader(nested(assignment.substr(0, equals), assignment.substr(equals + 1)), origin);
  walk(config, reader);
  reader.finish();
}

std::string fields_as_yaml(void* config, FieldWalk walk, bool with_help, Listed listed) {
  YamlLister lister(with_help, listed);
  walk(config, lister);
  return lister.text();
}

std::string fields_as_table(void* config, FieldWalk walk, Listed listed) {
  TableLister lister(listed);
  walk(config, lister);
  return lister.text();
}

}  // namespace samewhere::core
