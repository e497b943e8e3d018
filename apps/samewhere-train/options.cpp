#include "options.hpp"

#include <malloc.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/card.hpp>

namespace samewhere::train {

std::string as_typed(int argc, char** argv) {
  std::string command = "samewhere train";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_plain = word.find_first_of(" ?&*'\"$()") == std::string::npos && !word.empty();
    command += is_plain ? fmt::format(" {}", word) : fmt::format(" '{}'", word);
  }
  return command;
}

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return core::complain("samewhere",
                          fmt::format("{} (see {} --help)", error.what(), app.get_name()),
                          core::kBadInput);
  }
  return std::nullopt;
}

void require_writable_network(const std::filesystem::path& out) {
  if (out.extension() != ".onnx") {
    throw core::InputError(
        fmt::format("--out {}: expected a file name that ends in .onnx", out.string()));
  }
  require_free(out);
  core::make_writable_folder(std::filesystem::absolute(out).parent_path());
}

void use_threads(int num_threads) {
  set_num_threads(num_threads > 0 ? num_threads : core::num_hardware_threads());
  // the network's memory comes and goes with every step: kept, it need not be cleared each time
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const std::string advice = advice_on_linear_algebra();
  if (!advice.empty()) spdlog::warn("{}", advice);
}

}  // namespace samewhere::train
