// Live SLAM: a pose for each frame as it comes. A camera takes the place of the recording.
//   02_live_slam RECORDING
#include <iostream>

#include <samewhere/recording.hpp>
#include <samewhere/slam.hpp>

int main(int argc, char** argv) try {
  samewhere::Recording camera(argc > 1 ? argv[1] : "");
  samewhere::Slam slam(camera.calibration());
  while (const auto frame = camera.next()) {
    const samewhere::Tracked tracked = slam.track(*frame);
    if (!tracked.has_pose()) continue;
    std::cout << tracked.stamp_s << ' ' << tracked.map_from_camera().translation().transpose()
              << '\n';
    for (const samewhere::Event& event : slam.take_events()) {
      const auto* loop = std::get_if<samewhere::LoopVerdict>(&event.what);
      if (loop != nullptr && loop->decision == samewhere::LoopDecision::kAccepted)
        std::cout << "loop closed: frames " << loop->query.index << " and " << loop->match.index
                  << '\n';
    }
  }
  slam.finish();
  std::cout << slam.trajectory().size() << " poses, " << slam.map()->num_keyframes()
            << " keyframes\n";
} catch (const samewhere::InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
