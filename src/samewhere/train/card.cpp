#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/train/card.hpp>

namespace samewhere::train {
namespace {

std::filesystem::path beside(const std::filesystem::path& network, const char* ending) {
  std::filesystem::path path = network;
  return path.replace_extension(ending);
}

}  // namespace

std::filesystem::path checkpoint_of(const std::filesystem::path& network) {
  return beside(network, ".checkpoint");
}

std::filesystem::path card_of(const std::filesystem::path& network) {
  return beside(network, ".json");
}

void require_free(const std::filesystem::path& network) {
  if (is_there(checkpoint_of(network))) return;
  for (const std::filesystem::path& path : {network, card_of(network)}) {
    if (!is_there(path)) continue;
    throw core::InputError(
        fmt::format("--out {}: {} is there already, expected a name that is free", network.string(),
                    path.string()));
  }
}

OrderedJson settings_as_json(const std::string& yaml) {
  OrderedJson settings;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) settings[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return settings;
}

OrderedJson epochs_as_json(const std::vector<EpochFigures>& history) {
  OrderedJson epochs = OrderedJson::array();
  for (const EpochFigures& epoch : history) {
    epochs.push_back({{"epoch", epoch.epoch},
                      {"training_error", epoch.training_error},
                      {"validation_error", epoch.validation_error}});
  }
  return epochs;
}

std::string layer_text(const ConvolutionPlan& plan) {
  return fmt::format("convolution {0} x {0}, {1} to {2} channels, stride {3}, padding {4}",
                     plan.kernel_px, plan.num_inputs, plan.num_outputs, plan.stride_px,
                     plan.padding_px);
}

void write_with_card(const std::filesystem::path& network, const std::string& bytes,
                     const OrderedJson& card) {
  core::write_file(network, bytes);
  // names of files may hold any bytes
  core::write_file(card_of(network),
                   card.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
  std::error_code ignored;  // what stays does no harm
  std::filesystem::remove(checkpoint_of(network), ignored);
}

}  // namespace samewhere::train
