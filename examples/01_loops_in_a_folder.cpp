// Loops in a folder of images: which of them show a place of an earlier one? No camera file needed.
//   01_loops_in_a_folder FOLDER
#include <iostream>

#include <samewhere/loop_detector.hpp>
#include <samewhere/recording.hpp>

namespace {

void print(const std::vector<samewhere::LoopVerdict>& verdicts) {
  for (const samewhere::LoopVerdict& verdict : verdicts) {
    if (verdict.decision != samewhere::LoopDecision::kAccepted) continue;
    std::cout << verdict.query.index << " shows the place of " << verdict.match.index << ": "
              << verdict.reason << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) try {
  samewhere::Recording folder(argc > 1 ? argv[1] : "");
  samewhere::LoopDetector detector({}, samewhere::Prior::kUnique);
  while (const auto frame = folder.next()) print(detector.add(frame->images[0]));
  print(detector.finish());
} catch (const samewhere::InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
