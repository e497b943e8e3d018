#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/network_describer.hpp>
#include <samewhere/network/test_onnx.hpp>

namespace samewhere::describe {
namespace {

using network::test::onnx_file;
using testing::AllOf;
using testing::HasSubstr;

constexpr core::FrameId kView(5);
constexpr const char* kColourCard =
    R"({"input": {"colour": "rgb", "mean": [1, 2, 3], "scale": 0.01}})";
constexpr const char* kHeadCard =
    R"({"input": {"trunk": "trunk.onnx", "layer": "Relu_features", "rows": 24, "columns": 32,
        "colour": "bgr", "mean": 100, "scale": [0.01, 0.02, 0.03]}})";

class NetworkDescriber : public testing::Test {
 protected:
  NetworkDescriber()
      : folder_(std::filesystem::temp_directory_path() /
                ("samewhere-networks-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    write("trunk.onnx", onnx_file({.input = {1, 3, 24, 32}}));
    write("head.onnx", onnx_file({.input = {1, 8, 10, 14}}));
    write("head.json", kHeadCard);
  }
  ~NetworkDescriber() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  Config config(const std::string& network = "head.onnx") const {
    return {.method = Method::kAutoencoder,
            .network = (folder_ / network).string(),
            .trunks = folder_.string()};
  }

  std::string complaint(const Config& config) const {
    try {
      make_describer(config)->describe(kView, coloured(1));
    } catch (const core::InputError& error) {
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
    return "nothing";
  }

  static cv::Mat coloured(std::uint64_t seed) {
    core::Random random(seed);
    cv::Mat image(48, 64, CV_8UC3, cv::Scalar(120, 90, 60));
    const auto drawn = [&](int bound) {
      return static_cast<int>(random.index(static_cast<std::uint64_t>(bound)));
    };
    for (int i = 0; i < 12; ++i) {
      cv::rectangle(image, cv::Rect(drawn(50), drawn(40), 4 + drawn(20), 4 + drawn(20)),
                    cv::Scalar(drawn(256), drawn(256), drawn(256)), cv::FILLED);
    }
    return image;
  }

  std::filesystem::path folder_;
};

TEST_F(NetworkDescriber, ANetworkOfColourPicturesIsFedAsItsCardSays) {
  write("net.onnx", onnx_file({.input = {1, 3, 24, 32}}));
  write("net.json", kColourCard);
  const auto describer = make_describer(config("net.onnx"));
  const core::Descriptor descriptor = describer->describe(kView, coloured(1));
  EXPECT_EQ(descriptor.frame, kView);
  EXPECT_EQ(descriptor.describer_checksum, describer->checksum());
  EXPECT_EQ(descriptor.unit.size(), 16U);
  EXPECT_NEAR(core::dot(descriptor.unit, descriptor.unit), 1.0, 1e-5);
  cv::Mat swapped;
  cv::cvtColor(coloured(1), swapped, cv::COLOR_BGR2RGB);
  write("net.json", R"({"input": {"colour": "bgr", "mean": [1, 2, 3], "scale": 0.01}})");
  const auto other = make_describer(config("net.onnx"));
  EXPECT_NE(other->describe(kView, coloured(1)).unit, descriptor.unit);
  EXPECT_EQ(other->describe(kView, swapped).unit, descriptor.unit);
  EXPECT_NE(other->checksum(), describer->checksum());
}

TEST_F(NetworkDescriber, AHeadDescribesAViewByTheFeaturesOfItsTrunk) {
  const auto describer = make_describer(config());
  const std::vector<float> first = describer->describe(kView, coloured(1)).unit;
  EXPECT_EQ(first.size(), 16U);
  EXPECT_NEAR(core::dot(first, first), 1.0, 1e-5);
  EXPECT_LT(core::cosine(first, describer->describe(kView, coloured(2)).unit), 0.999);
  EXPECT_EQ(describer->describe(kView, coloured(1)).unit, first);
}

TEST_F(NetworkDescriber, AViewOfOneColourIsAllZero) {
  const auto describer = make_describer(config());
  for (const cv::Mat& image :
       {cv::Mat(48, 64, CV_8UC3, cv::Scalar(10, 200, 30)), cv::Mat(1, 1, CV_8UC1, cv::Scalar(9))}) {
    const std::vector<float> unit = describer->describe(kView, image).unit;
    EXPECT_EQ(unit.size(), 16U);
    EXPECT_THAT(unit, testing::Each(0.0F));
  }
}

TEST_F(NetworkDescriber, TheChecksumIsOfTrunkHeadAndCardNotOfTheirFolder) {
  const std::uint64_t checksum = make_describer(config())->checksum();
  std::filesystem::copy(folder_, folder_ / "copy");
  Config copied = config();
  copied.network = (folder_ / "copy" / "head.onnx").string();
  copied.trunks = (folder_ / "copy").string();
  EXPECT_EQ(make_describer(copied)->checksum(), checksum);
  write("head.onnx", onnx_file({.input = {1, 8, 10, 14}, .seed = 2}));
  EXPECT_NE(make_describer(config())->checksum(), checksum);
  write("head.onnx", onnx_file({.input = {1, 8, 10, 14}}));
  write("trunk.onnx", onnx_file({.input = {1, 3, 24, 32}, .seed = 2}));
  EXPECT_NE(make_describer(config())->checksum(), checksum);
  write("trunk.onnx", onnx_file({.input = {1, 3, 24, 32}}));
  std::string card = kHeadCard;
  card.replace(card.find("0.03"), 4, "0.04");
  write("head.json", card);
  EXPECT_NE(make_describer(config())->checksum(), checksum);
}

TEST_F(NetworkDescriber, AHeadThatDoesNotFitItsTrunkIsRefused) {
  write("head.onnx", onnx_file({.input = {1, 8, 12, 14}}));
  EXPECT_THAT(complaint(config()), AllOf(HasSubstr("head.onnx"), HasSubstr("1x8x12x14"),
                                         HasSubstr("Relu_features of trunk.onnx gives 1x8x10x14")));
}

TEST_F(NetworkDescriber, AMissingTrunkOrLayerIsNamed) {
  std::filesystem::rename(folder_ / "trunk.onnx", folder_ / "gone.onnx");
  EXPECT_THAT(complaint(config()), AllOf(HasSubstr("describe.trunks: there is no trunk.onnx in"),
                                         HasSubstr(folder_.string())));
  std::filesystem::rename(folder_ / "gone.onnx", folder_ / "trunk.onnx");
  std::string card = kHeadCard;
  card.replace(card.find("Relu_features"), 13, "nowhere");
  write("head.json", card);
  EXPECT_THAT(complaint(config()), AllOf(HasSubstr("trunk.onnx"), HasSubstr("no layer nowhere")));
}

TEST_F(NetworkDescriber, ACardThatSaysNothingUsefulIsRefusedByItsKey) {
  const auto complaint_of = [this](const std::string& card) {
    write("head.json", card);
    return complaint(config());
  };
  EXPECT_THAT(complaint_of("not json"), HasSubstr("head.json: expected JSON"));
  EXPECT_THAT(complaint_of("{\"input\": 7}"), HasSubstr("expected JSON"));
  EXPECT_THAT(complaint_of(kColourCard), HasSubstr("input.trunk is missing"));
  const std::string card = kHeadCard;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = card;
    changed.replace(changed.find(from), from.size(), to);
    return complaint_of(changed);
  };
  EXPECT_THAT(with("\"bgr\"", "\"yuv\""),
              HasSubstr("input.colour is \"yuv\"; expected rgb or bgr"));
  EXPECT_THAT(with("24", "0"), HasSubstr("input.rows is 0"));
  EXPECT_THAT(with("32", "1.5"), HasSubstr("input.columns is 1.5"));
  EXPECT_THAT(with("100", "\"x\""), HasSubstr("input.mean is \"x\""));
  EXPECT_THAT(with("0.03]", "0.03, 1]"), HasSubstr("expected one number or three"));
  EXPECT_THAT(with("\"Relu_features\"", "3"), HasSubstr("input.layer is 3; expected a text"));
}

TEST_F(NetworkDescriber, ACodeThatIsNoNumberIsRefusedByFrame) {
  write("head.onnx", onnx_file({.input = {1, 8, 10, 14}, .bias = NAN}));
  EXPECT_THAT(complaint(config()),
              AllOf(HasSubstr("number 0 of the network's code is"), HasSubstr("for frame 5")));
}

TEST_F(NetworkDescriber, EveryMethodWithoutItsTrunkNamesTheFile) {
  for (const Method method :
       {Method::kSqueezenet, Method::kGem, Method::kNetvlad, Method::kDarknet})
    EXPECT_THAT(complaint({.method = method, .trunks = (folder_ / "copy").string()}),
                HasSubstr("there is no "));
}

// The published networks, where they lie beside the recordings.
TEST_F(NetworkDescriber, SqueezeNetGivesTheMeanOfItsLastMap) {
  const char* const data = std::getenv("SAMEWHERE_DATA");
  if (data == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
  const auto trunks = std::filesystem::path(data) / ".." / "models";
  if (!std::filesystem::exists(trunks / "squeezenet_v1.onnx")) GTEST_SKIP() << "no squeezenet";
  const auto describer = make_describer({.method = Method::kSqueezenet, .trunks = trunks.string()});
  const std::vector<float> unit = describer->describe(kView, coloured(1)).unit;
  EXPECT_EQ(unit.size(), 512U);
  EXPECT_NEAR(core::dot(unit, unit), 1.0, 1e-5);
  EXPECT_EQ(describer->describe(kView, coloured(1)).unit, unit);
  EXPECT_LT(core::cosine(unit, describer->describe(kView, coloured(2)).unit), 0.999);
}

}  // namespace
}  // namespace samewhere::describe
