#include <array>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::twin {
namespace {

constexpr std::string_view kScheme = "twin:";
constexpr std::array<Preset, 8> kPresets = {{
    {"office-loop", "one lap and a quarter around a block of offices; easy"},
    {"twin-corridors", "two identical parallel corridors, then the first once more"},
    {"hotel", "five floors alike around a stair, the top floor twice"},
    {"no-return", "forty identical doors and never a revisit"},
    {"warehouse", "a robot through four aisles of racks and half of the first again"},
    {"mirror", "a building symmetric about its core: west wing, east wing, west wing"},
    {"long-haul", "thirty minutes through three floors of wings alike"},
    {"second-visit", "the same building again in another light, with things moved"},
}};

struct SensorsName {
  std::string_view name;
  Sensors sensors;
};
constexpr std::array<SensorsName, 3> kSensors = {
    {{"rgbd", Sensors::kRgbd}, {"stereo", Sensors::kStereo}, {"mono", Sensors::kMono}}};

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(separator); end != std::string_view::npos;
       end = text.find(separator)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

// One "key=value" of a spec, and the spec itself for the message.
struct Setting {
  const std::string& spec;
  std::string_view key;
  std::string_view value;
};

template <class T>
T number(const Setting& setting, T min, T max, std::string_view expected) {
  T parsed{};
  const char* const last = setting.value.data() + setting.value.size();
  const auto [end, error] = std::from_chars(setting.value.data(), last, parsed);
  const bool is_whole = error == std::errc{} && end == last;
  if (is_whole && parsed >= min && parsed <= max) return parsed;
  throw core::InputError(
      fmt::format("{}: {} = {} is not {}", setting.spec, setting.key, setting.value, expected));
}

Sensors sensors_of(const Setting& setting) {
  for (const auto& [name, sensors] : kSensors) {
    if (setting.value == name) return sensors;
  }
  throw core::InputError(fmt::format("{}: {} = {} is not rgbd, stereo or mono", setting.spec,
                                     setting.key, setting.value));
}

void apply(const Setting& setting, Spec& spec) {
  if (setting.key == "seed") {
    spec.seed = number<std::uint64_t>(setting, 0, ~std::uint64_t{0}, "a whole number >= 0");
  } else if (setting.key == "similarity") {
    spec.similarity = number(setting, 0.0, 1.0, "a number in [0, 1]");
  } else if (setting.key == "speed") {
    spec.speed = number(setting, 0.5, 2.0, "a number in [0.5, 2]");
  } else if (setting.key == "people") {
    spec.people = number(setting, 0, 30, "a whole number in [0, 30]");
  } else if (setting.key == "stray") {
    spec.stray_m = number(setting, 0.0, 1.0, "a number in [0, 1]");
  } else if (setting.key == "camera") {
    spec.sensors = sensors_of(setting);
  } else if (setting.key == "copy") {
    spec.copy = number(setting, 0, 1000, "a whole number in [0, 1000]");
  } else {
    throw core::InputError(
        fmt::format("{}: unknown key {}; expected one of: seed, similarity, speed, people, stray, "
                    "camera, copy",
                    setting.spec, setting.key));
  }
}

void check_preset(const std::string& text, std::string_view preset) {
  std::vector<std::string_view> names;
  for (const auto& known : kPresets) {
    if (preset == known.name) return;
    names.push_back(known.name);
  }
  throw core::InputError(fmt::format("{}: unknown preset {}; expected one of: {}", text, preset,
                                     fmt::join(names, ", ")));
}

}  // namespace

std::span<const Preset> list_presets() { return kPresets; }

bool is_twin_spec(std::string_view text) { return text.starts_with(kScheme); }

Spec parse_spec(const std::string& text) {
  if (!is_twin_spec(text)) {
    throw core::InputError(text + ": expected twin:PRESET?key=value&key=value");
  }
  const std::string_view after_scheme = std::string_view(text).substr(kScheme.size());
  const std::size_t question = after_scheme.find('?');
  Spec spec{.preset = std::string(after_scheme.substr(0, question))};
  check_preset(text, spec.preset);
  if (question == std::string_view::npos) return spec;

  std::vector<std::string_view> seen;
  for (const auto& part : split(after_scheme.substr(question + 1), '&')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) {
      throw core::InputError(fmt::format("{}: expected key=value, found \"{}\"", text, part));
    }
    const Setting setting{text, part.substr(0, equals), part.substr(equals + 1)};
    for (const auto& key : seen) {
      if (key == setting.key) throw core::InputError(fmt::format("{}: {} given twice", text, key));
    }
    seen.push_back(setting.key);
    apply(setting, spec);
  }
  return spec;
}

std::string canonical_text(const Spec& spec) {
  std::string_view camera;
  for (const auto& [name, sensors] : kSensors) {
    if (spec.sensors == sensors) camera = name;
  }
  // named only where they change something: texts, and what is kept under them, are older
  const std::string stray = spec.stray_m > 0.0 ? fmt::format("&stray={}", spec.stray_m) : "";
  const std::string copy = spec.copy > 0 ? fmt::format("&copy={}", spec.copy) : "";
  return fmt::format("{}{}?seed={}&similarity={}&speed={}&people={}&camera={}{}{}", kScheme,
                     spec.preset, spec.seed, spec.similarity, spec.speed, spec.people, camera,
                     stray, copy);
}

}  // namespace samewhere::twin
