#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/train/checkpoint.hpp>
#include <samewhere/train/sha256.hpp>

namespace samewhere::train {
namespace {

using core::InputError;
using nlohmann::json;

constexpr std::string_view kFormat = "samewhere training 3 ";

std::size_t num_weights(const ConvolutionPlan& plan) {
  return static_cast<std::size_t>(plan.num_outputs) * static_cast<std::size_t>(plan.num_inputs) *
         static_cast<std::size_t>(plan.kernel_px * plan.kernel_px);
}

std::string bytes_of(const std::vector<float>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

std::vector<float> numbers_of(std::string_view bytes) {
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

std::string first_line(std::string_view content) {
  return fmt::format("{}{}\n", kFormat, sha256_of(content));
}

std::string_view after_line(std::string_view text) {
  return text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
}

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view why) {
  throw InputError(fmt::format(
      "{}: {}, expected the checkpoint of a training; remove it to start from the beginning",
      path.string(), why));
}

Checkpoint from_header(const json& header) {
  Checkpoint checkpoint{.settings = header.at("settings"),
                        .network = header.at("network"),
                        .images_sha256 = header.at("images_sha256"),
                        .commits = header.at("commits")};
  for (const json& row : header.at("history")) {
    checkpoint.history.push_back({row.at(0), row.at(1), row.at(2)});
  }
  return checkpoint;
}

}  // namespace

// The file: a line with the format and the checksum of all that follows; a line of JSON; then the
// three blocks of bytes whose lengths it gives.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  json history = json::array();
  for (const EpochFigures& epoch : checkpoint.history) {
    history.push_back({epoch.epoch, epoch.training_error, epoch.validation_error});
  }
  const json header = {{"settings", checkpoint.settings},
                       {"network", checkpoint.network},
                       {"commits", checkpoint.commits},
                       {"images_sha256", checkpoint.images_sha256},
                       {"history", history},
                       {"num_learner_bytes", checkpoint.learner.size()},
                       {"num_best_parameters", checkpoint.best_parameters.size()},
                       {"num_best_codes", checkpoint.best_codes.size()}};
  const std::string content = header.dump() + "\n" + checkpoint.learner +
                              bytes_of(checkpoint.best_parameters) +
                              bytes_of(checkpoint.best_codes);
  core::write_file(path, first_line(content) + content);
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  const std::string file = core::read_file(path, core::kDataLimit);
  if (!file.starts_with(kFormat)) fail(path, "is of another format");
  const std::string_view content = after_line(file);
  if (!file.starts_with(first_line(content))) fail(path, "is damaged or cut short");
  try {
    const std::string_view blocks = after_line(content);
    const json header = json::parse(content.substr(0, content.size() - blocks.size()));
    const auto num_bytes = header.at("num_learner_bytes").get<std::size_t>();
    const auto codes_start =
        num_bytes + header.at("num_best_parameters").get<std::size_t>() * sizeof(float);
    const auto size = codes_start + header.at("num_best_codes").get<std::size_t>() * sizeof(float);
    core::require(blocks.size() == size, "a checkpoint is as long as it says");
    Checkpoint checkpoint = from_header(header);
    checkpoint.learner = blocks.substr(0, num_bytes);
    checkpoint.best_parameters = numbers_of(blocks.substr(num_bytes, codes_start - num_bytes));
    checkpoint.best_codes = numbers_of(blocks.substr(codes_start));
    return checkpoint;
  } catch (const json::exception&) {
    fail(path, "holds something else than its checksum says");
  }
}

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  const bool is_there = std::filesystem::exists(path, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be looked up: {}", path.string(), error.message()));
  }
  return is_there;
}

std::vector<float> parameters_of(std::span<const Convolution> convolutions) {
  std::vector<float> parameters;
  for (const Convolution& convolution : convolutions) {
    parameters.insert(parameters.end(), convolution.weights.begin(), convolution.weights.end());
    parameters.insert(parameters.end(), convolution.biases.begin(), convolution.biases.end());
  }
  return parameters;
}

std::vector<Convolution> convolutions_with(std::span<const ConvolutionPlan> plans,
                                           std::span<const float> parameters) {
  const auto take = [&](std::size_t count) {
    core::require(count <= parameters.size(), "the parameters are those of the plan");
    const std::vector<float> taken(parameters.begin(),
                                   parameters.begin() + static_cast<std::ptrdiff_t>(count));
    parameters = parameters.subspan(count);
    return taken;
  };
  std::vector<Convolution> convolutions;
  for (const ConvolutionPlan& plan : plans) {
    std::vector<float> weights = take(num_weights(plan));
    std::vector<float> biases = take(static_cast<std::size_t>(plan.num_outputs));
    convolutions.push_back({plan, std::move(weights), std::move(biases)});
  }
  core::require(parameters.empty(), "the parameters are those of the plan");
  return convolutions;
}

}  // namespace samewhere::train
