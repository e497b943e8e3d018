#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/describe/preprocess.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/network/test_onnx.hpp>

namespace samewhere::describe {
namespace {

using network::test::onnx_file;
namespace test = network::test;
using testing::AllOf;
using testing::HasSubstr;

constexpr core::FrameId kFrame(7);

class Autoencoder : public testing::Test {
 protected:
  Autoencoder()
      : folder_(std::filesystem::temp_directory_path() /
                ("samewhere-autoencoder-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Autoencoder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  Config config_for(const std::string& file_bytes, const std::string& name = "net.onnx") const {
    std::ofstream(path(name), std::ios::binary) << file_bytes;  // sooner done than write_file
    return {.method = Method::kAutoencoder, .network = path(name).string()};
  }

  // What is said of a network that cannot be used, which must name the file.
  std::string complaint(const std::string& file_bytes) const {
    try {
      make_describer(config_for(file_bytes))->describe(kFrame, room(1));
    } catch (const core::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("net.onnx"));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
    return "nothing";
  }

  static cv::Mat room(std::uint64_t seed) {
    core::Random random(seed);
    cv::Mat image(480, 640, CV_8UC3, cv::Scalar(120, 120, 120));
    const auto drawn = [&](int bound) {
      return static_cast<int>(random.index(static_cast<std::uint64_t>(bound)));
    };
    for (int i = 0; i < 30; ++i) {
      cv::rectangle(image, cv::Rect(drawn(600), drawn(440), 20 + drawn(150), 20 + drawn(150)),
                    cv::Scalar(drawn(256), drawn(256), drawn(256)), cv::FILLED);
    }
    return image;
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(Autoencoder, AViewBecomesTheNetworksCodeOfUnitLength) {
  const auto describer = make_describer(config_for(onnx_file({})));
  const core::Descriptor descriptor = describer->describe(kFrame, room(1));
  EXPECT_EQ(descriptor.frame, kFrame);
  EXPECT_EQ(descriptor.describer_checksum, describer->checksum());
  EXPECT_EQ(descriptor.unit.size(), 16U);
  EXPECT_NEAR(core::dot(descriptor.unit, descriptor.unit), 1.0, 1e-5);
  EXPECT_LT(core::cosine(descriptor.unit, describer->describe(kFrame, room(2)).unit), 0.999);
}

// The layers of test_onnx.hpp, the slow way.
TEST_F(Autoencoder, TheNetworkIsFedThePreprocessedViewReducedAndScaledToOne) {
  const auto describer = make_describer(config_for(onnx_file({})));
  core::Random random(1);
  const std::vector<float> kernel = test::random_weights(random, 8 * 25, 0.2);
  cv::Mat small;
  cv::resize(preprocess(room(1), Config{}), small, cv::Size(32, 24), 0.0, 0.0, cv::INTER_AREA);
  std::vector<double> features;
  for (int channel = 0; channel < 8; ++channel) {
    for (int y = 0; y + 5 <= 24; y += 2) {
      for (int x = 0; x + 5 <= 32; x += 2) {
        double sum = 0.0;
        for (int i = 0; i < 25; ++i) {
          sum += kernel[static_cast<std::size_t>(channel * 25 + i)] *
                 small.at<std::uint8_t>(y + i / 5, x + i % 5) / 255.0;
        }
        features.push_back(std::max(sum, 0.0));
      }
    }
  }
  const int length = static_cast<int>(features.size());
  const std::vector<float> matrix = test::random_weights(random, 16 * length, 0.05);
  std::vector<float> code(16);
  for (std::size_t row = 0; row < code.size(); ++row) {
    double sum = 0.0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      sum += matrix[row * features.size() + i] * features[i];
    }
    code[row] = static_cast<float>(sum);
  }
  EXPECT_GT(core::cosine(describer->describe(kFrame, room(1)).unit, code), 1.0 - 1e-9);
}

TEST_F(Autoencoder, TheSameViewGivesTheSameBitsWhateverTheThreadsDo) {
  const auto describer =
      make_describer(config_for(onnx_file({.input = {1, 1, 61, 83}, .code_length = 101})));
  const int threads_before = cv::getNumThreads();
  cv::setNumThreads(1);
  const std::vector<float> expected = describer->describe(kFrame, room(1)).unit;
  for (const int num_threads : {2, 3, 4, 7, 16}) {
    cv::setNumThreads(num_threads);
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(describer->describe(kFrame, room(1)).unit, expected) << num_threads << " threads";
    }
  }
  cv::setNumThreads(threads_before);
}

TEST_F(Autoencoder, AViewOfOneGreyLevelIsAllZeroWhateverTheNetworkMakesOfIt) {
  const auto describer = make_describer(config_for(onnx_file({.bias = 3.0F})));
  for (const cv::Mat& image :
       {cv::Mat(480, 640, CV_8UC3, cv::Scalar(0, 0, 0)), cv::Mat(1, 1, CV_8UC1, cv::Scalar(9))}) {
    const std::vector<float> unit = describer->describe(kFrame, image).unit;
    EXPECT_EQ(unit.size(), 16U);
    EXPECT_THAT(unit, testing::Each(0.0F));
  }
}

TEST_F(Autoencoder, TheChecksumIsOfTheWeightsAndSettingsNotOfTheFilesName) {
  const Config config = config_for(onnx_file({}));
  const std::uint64_t checksum = make_describer(config)->checksum();
  EXPECT_EQ(make_describer(config_for(onnx_file({}), "renamed.onnx"))->checksum(), checksum);
  EXPECT_NE(make_describer(config_for(onnx_file({.seed = 2}), "b.onnx"))->checksum(), checksum);
  EXPECT_NE(make_describer(Config{})->checksum(), checksum);
  for (const char* setting : {"width_px=640", "height_px=480", "equalize=false"}) {
    Config changed = config;
    core::set_config(changed, setting);
    EXPECT_NE(make_describer(changed)->checksum(), checksum) << setting;
  }
}

TEST_F(Autoencoder, OfAFreeBatchSizeOneIsTaken) {
  EXPECT_EQ(complaint(onnx_file({.input = {-1, 1, 24, 32}})), "nothing");
}

TEST_F(Autoencoder, TheCodeIsTheOutputThatTheFileDeclaresNotItsLastLayer) {
  const auto plain = make_describer(config_for(onnx_file({}), "plain.onnx"));
  const auto longer = make_describer(config_for(onnx_file({.has_node_behind_code = true})));
  EXPECT_EQ(longer->describe(kFrame, room(1)).unit, plain->describe(kFrame, room(1)).unit);
}

TEST_F(Autoencoder, AFileCutAnywhereIsRefused) {
  const std::string whole = onnx_file({.input = {1, 1, 8, 8}, .code_length = 2});
  // everywhere near both ends, and at places in between
  for (std::size_t length = 0; length < whole.size();
       length += length < 60 || length + 100 > whole.size() ? 1 : 17) {
    EXPECT_THAT(complaint(whole.substr(0, length)), HasSubstr("cut short or no ONNX"))
        << length << " of " << whole.size() << " bytes";
  }
}

TEST_F(Autoencoder, WhatIsNoOnnxFileIsRefused) {
  EXPECT_THAT(complaint("%YAML 1.2\nnot: a network\n"), HasSubstr("no ONNX file"));
  EXPECT_THAT(complaint(std::string(5000, '\0')), HasSubstr("no ONNX file"));
  EXPECT_THAT(complaint(std::string(5000, '\xff')), HasSubstr("no ONNX file"));
  core::Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    std::string noise(1 + random.index(300), '\0');
    for (char& c : noise) c = static_cast<char>(random.index(256));
    EXPECT_THAT(complaint(noise), HasSubstr("no ONNX file")) << "trial " << trial;
  }
}

TEST_F(Autoencoder, ANetworkForOtherPicturesIsRefused) {
  EXPECT_THAT(complaint(onnx_file({.input = {1, 3, 24, 32}})),
              AllOf(HasSubstr("image is 1x3x24x32"), HasSubstr("expected a card net.json")));
  EXPECT_THAT(complaint(onnx_file({.input = {4, 1, 24, 32}})),
              AllOf(HasSubstr("4x1x24x32"), HasSubstr("expected one picture")));
  EXPECT_THAT(complaint(onnx_file({.input = {1, 1, 24, 8000}})), HasSubstr("1x1x24x8000"));
  EXPECT_THAT(complaint(onnx_file({.element = 7})), HasSubstr("1x1x24x32 not of floats"));
  EXPECT_THAT(complaint(onnx_file({.has_second_output = true})), HasSubstr("2 outputs"));
}

TEST_F(Autoencoder, ANetworkWithoutACodeIsRefused) {
  EXPECT_THAT(complaint(onnx_file({.code_length = 0})),
              AllOf(HasSubstr("output code is 1x8x10x14"), HasSubstr("expected one vector, 1xN")));
  EXPECT_THAT(complaint(onnx_file({.code_length = 1})), HasSubstr("output code is 1x1"));
}

TEST_F(Autoencoder, ALayerThatTheBackendDoesNotKnowIsNamed) {
  std::string file = onnx_file({});
  file.replace(file.find("\"\4Relu", 0), 6, "\"\4Rleu");
  EXPECT_THAT(complaint(file), HasSubstr("as an ONNX network"));
}

TEST_F(Autoencoder, ACodeThatIsNoNumberIsRefused) {
  for (const float broken :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_THAT(complaint(onnx_file({.bias = broken})),
                AllOf(HasSubstr("number 0 of the network's code is"), HasSubstr("for frame 7")));
  }
}

TEST_F(Autoencoder, AMissingNetworkIsNamedWithBothPlacesLookedAt) {
  const Config config{.method = Method::kAutoencoder, .network = "no/such.onnx"};
  try {
    make_describer(config);
    FAIL() << "described without a network";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("describe.network = no/such.onnx"), HasSubstr("/models")));
  }
  EXPECT_THROW(make_describer({.method = Method::kAutoencoder, .network = ""}), core::InputError);
  EXPECT_THROW(make_describer({.method = Method::kAutoencoder, .network = path("").string()}),
               core::InputError);
}

TEST_F(Autoencoder, APictureOfAnotherSizeIsAMistakeOfOurs) {
  const Config config = config_for(onnx_file({}));
  const auto inference = network::make_inference(network::read_network(config.network));
  EXPECT_THROW(inference->run(cv::Mat(32, 24, CV_32FC1, cv::Scalar(0))), core::ContractError);
  EXPECT_THROW(inference->run(cv::Mat(24, 32, CV_8UC1, cv::Scalar(0))), core::ContractError);
  EXPECT_FALSE(network::inference_backend().empty());
}

}  // namespace
}  // namespace samewhere::describe
