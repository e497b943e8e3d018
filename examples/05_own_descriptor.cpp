// Loops by your own global descriptor: an ONNX network from a grey image, 1 x 1 x height x width,
// to a vector, 1 x N. Similarities are cosines. Without FILE.onnx: the autoencoder that comes
// along.
//   05_own_descriptor FOLDER [FILE.onnx WIDTH HEIGHT]
#include <iostream>

#include <samewhere/loop_detector.hpp>
#include <samewhere/recording.hpp>

int main(int argc, char** argv) try {
  std::vector<std::string> settings = {"describe.method=autoencoder"};
  if (argc > 4) {
    settings.push_back(std::string("describe.network=") + argv[2]);
    settings.push_back(std::string("describe.width_px=") + argv[3]);
    settings.push_back(std::string("describe.height_px=") + argv[4]);
  }
  samewhere::Recording folder(argc > 1 ? argv[1] : "");
  samewhere::LoopDetector detector(settings);
  while (const auto frame = folder.next()) {
    for (const samewhere::LoopVerdict& verdict : detector.add(frame->images[0]))
      std::cout << verdict.query.index << ' ' << verdict.match.index << " similarity "
                << verdict.scores.similarity << ": " << verdict.reason << '\n';
  }
} catch (const samewhere::InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
