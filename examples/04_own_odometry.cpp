// Loop closures for odometry from elsewhere: wheels, lidar, a VIO. Lines "stamp tx ty tz qx qy qz
// qw" of the body, one for each image, take the place of the sensor.
//   04_own_odometry RECORDING ODOMETRY.txt
#include <fstream>
#include <iostream>

#include <samewhere/loop_closer.hpp>
#include <samewhere/recording.hpp>

int main(int argc, char** argv) try {
  samewhere::Recording camera(argc > 1 ? argv[1] : "");
  std::ifstream odometry(argc > 2 ? argv[2] : "");
  samewhere::LoopCloser closer(
      camera.calibration(), {.sensor = samewhere::OdometrySensor::kWheel, .are_keyframes = false});
  double stamp_s = 0.0;
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  while (odometry >> stamp_s >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w()) {
    const auto frame = camera.next();
    if (!frame) break;
    samewhere::Pose odom_from_body = samewhere::Pose::Identity();
    odom_from_body.linear() = q.normalized().toRotationMatrix();
    odom_from_body.translation() = t;
    for (const samewhere::LoopVerdict& verdict : closer.add({*frame, odom_from_body, {}}))
      std::cout << verdict.query.index << ' ' << verdict.match.index << ' ' << verdict.check << ": "
                << verdict.reason << '\n';
  }
  closer.finish();
  std::cout << closer.poses().size() << " corrected poses, " << closer.map()->loops().size()
            << " loops\n";
} catch (const samewhere::InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
