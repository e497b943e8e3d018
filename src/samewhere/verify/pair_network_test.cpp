#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/network/test_onnx.hpp>
#include <samewhere/verify/pair_network.hpp>

namespace samewhere::verify {
namespace {

using testing::HasSubstr;

class PairNetworkFile : public testing::Test {
 protected:
  std::string write(const network::test::TestNetwork& network) const {
    const std::string path =
        testing::TempDir() + "samewhere_pair_network_" + std::to_string(getpid()) + ".onnx";
    core::write_file(path, network::test::onnx_file(network));
    return path;
  }

  std::string complaint(const std::string& file) const {
    try {
      PairNetwork("verify.pair_network", file);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "nothing";
  }
};

PairView pair_of(double level) {
  return {.planes =
              cv::Mat(kNumPairPlanes * kPairSide_px, kPairSide_px, CV_32F, cv::Scalar(level))};
}

TEST_F(PairNetworkFile, AnswersWithTheNumberThatTheNetworkMakesOfThePlanes) {
  const std::string file = write({.input = {1, 1, kNumPairPlanes * kPairSide_px, kPairSide_px},
                                  .code_length = 1,
                                  .bias = 0.25F});
  PairNetwork network("verify.pair_network", file);
  EXPECT_DOUBLE_EQ(network.probability_of_same(pair_of(0.0)), 0.25);
  EXPECT_NE(network.probability_of_same(pair_of(0.5)), 0.25);
  EXPECT_NE(network.checksum(), 0U);
}

// And look at what they are shown.
TEST_F(PairNetworkFile, TheShippedNetworksGiveProbabilities) {
  for (const char* file : {"pairs.onnx", "pairs-features.onnx"}) {
    PairNetwork network("verify.pair_network", file);
    const auto probability = [&](PairPlane shown) {
      PairView pair = pair_of(0.0);
      pair.plane(PairPlane::kSeenByBoth).setTo(1.0F);
      for (int i = 8; i < kPairSide_px; i += 12)
        for (int k = 8; k < kPairSide_px; k += 12) pair.plane(shown).at<float>(i, k) = 1.0F;
      return network.probability_of_same(pair);
    };
    const double agreeing = probability(PairPlane::kAgree);
    const double lacking = probability(PairPlane::kOnlyQueryShows);
    EXPECT_TRUE(lacking > 0.0 && lacking < 1.0 && agreeing > 0.0 && agreeing < 1.0) << file;
    EXPECT_GT(std::abs(agreeing - lacking), 1e-4) << file;
  }
}

TEST_F(PairNetworkFile, AnotherNetworkIsRefused) {
  EXPECT_THAT(complaint(write({.code_length = 1})),
              testing::AllOf(HasSubstr("1x1x24x32"), HasSubstr("expected the planes of a pair")));
  EXPECT_THAT(complaint(write({.input = {1, 1, kNumPairPlanes * kPairSide_px, kPairSide_px},
                               .code_length = 2})),
              testing::AllOf(HasSubstr("is 1x2"), HasSubstr("expected one number")));
  EXPECT_THAT(complaint("no/such.onnx"), HasSubstr("verify.pair_network = no/such.onnx"));
}

TEST_F(PairNetworkFile, AnAnswerThatIsNoNumberIsRefused) {
  const std::string file = write({.input = {1, 1, kNumPairPlanes * kPairSide_px, kPairSide_px},
                                  .code_length = 1,
                                  .bias = NAN});
  PairNetwork network("verify.pair_network", file);
  EXPECT_THROW(network.probability_of_same(pair_of(0.0)), core::InputError);
}

}  // namespace
}  // namespace samewhere::verify
