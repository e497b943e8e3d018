// A map is made and saved; a second session localizes in it and leaves it as it is.
//   03_localize_in_a_map RECORDING MAP.sw
#include <filesystem>
#include <iostream>

#include <samewhere/recording.hpp>
#include <samewhere/slam.hpp>

namespace {

void run(const std::string& source, const samewhere::Options& options) {
  samewhere::Recording camera(source);
  samewhere::Slam slam(camera.calibration(), options);
  int num_found = 0;
  while (const auto frame = camera.next()) num_found += slam.track(*frame).has_pose() ? 1 : 0;
  slam.finish();
  std::cout << num_found << " frames with a pose, map of " << slam.map()->num_keyframes()
            << " keyframes\n";
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string source = argc > 1 ? argv[1] : "";
  const std::filesystem::path map = argc > 2 ? argv[2] : "example.sw";
  if (!std::filesystem::exists(map)) run(source, {.save_to = map});
  // no two places of this building look alike
  run(source,
      {.prior = samewhere::Prior::kUnique, .map = map, .map_use = samewhere::MapUse::kLocalize});
} catch (const samewhere::InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
