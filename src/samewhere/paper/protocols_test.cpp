#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/input/test_folder.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/protocols.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::paper {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Protocols : public testing::Test {
 protected:
  std::string data_set_of(const std::string& folder) const {
    const auto protocol = protocol_of(folder_.root() / folder);
    return protocol ? protocol->data_set : "none";
  }

  input::TestFolder folder_;
};

TEST_F(Protocols, ADataSetIsKnownByTheNameOfItsFolder) {
  EXPECT_EQ(data_set_of("Lip6IndoorDataSet"), "Lip6 Indoor");
  EXPECT_EQ(data_set_of("lip6_indoor"), "Lip6 Indoor");
  EXPECT_EQ(data_set_of("Bicocca_2009-02-25b"), "Bicocca 25b");
  EXPECT_EQ(data_set_of("NewCollege"), "New College");
  EXPECT_EQ(data_set_of("city-centre"), "City Centre");
  EXPECT_EQ(data_set_of("GardensPoint_Walking"), "GardensPoint");
  EXPECT_EQ(data_set_of("rgbd_dataset_freiburg3_long_office_household"),
            "TUM fr3/long_office_household");
  EXPECT_EQ(data_set_of("rtabmap_corridor"), "rtabmap_corridor");
  EXPECT_EQ(data_set_of("redkitchen/"), "redkitchen");
  EXPECT_EQ(data_set_of("tum_fr1_rpy"), "tum_fr1_rpy");
  EXPECT_EQ(data_set_of("my_redkitchen_copy"), "none");
  EXPECT_EQ(data_set_of("newer_college"), "none");
}

TEST_F(Protocols, ADataSetIsKnownByItsFiles) {
  folder_.write("a/Images/lip6kennedy_bigdoubleloop_000000.ppm", "");
  folder_.write("b/Bicocca_2009-02-25b-GROUNDTRUTH.csv", "");
  folder_.write("b/FRONTAL/x.png", "");
  folder_.write("c/NewCollegeGroundTruth.mat", "");
  folder_.write("d/day_right/Image000.jpg", "");
  folder_.write("e/color.txt", "");
  folder_.write("e/sensors.yaml", "");
  folder_.write("f/FRONTAL/x.png", "");
  EXPECT_EQ(data_set_of("a"), "Lip6 Indoor");
  EXPECT_EQ(data_set_of("b"), "Bicocca 25b");
  EXPECT_EQ(data_set_of("c"), "New College");
  EXPECT_EQ(data_set_of("d"), "GardensPoint");
  EXPECT_EQ(data_set_of("e"), "OpenLORIS-Scene");
  EXPECT_EQ(data_set_of("f"), "none");
  EXPECT_EQ(data_set_of("nowhere"), "none");
}

TEST_F(Protocols, WithoutAWindowThatOfTheProtocolApplies) {
  const std::string corridor = (folder_.root() / "rtabmap_corridor").string();
  const std::string lip6 = (folder_.root() / "Lip6Indoor").string();
  const pipeline::Config config = pipeline::profile("paper");
  EXPECT_EQ(with_source(config, corridor).retrieve.window_frames, 19);
  EXPECT_EQ(with_source(config, corridor).input.truth_tolerance_frames, 0);
  EXPECT_EQ(with_source(config, corridor + "@7").retrieve.window_frames, 7);
  EXPECT_EQ(with_source(config, lip6).retrieve.window_frames, -1);
  EXPECT_EQ(with_source(config, lip6).retrieve.window_s, 30.0);
  EXPECT_EQ(with_source(config, lip6).input.truth_tolerance_frames, 10);
  EXPECT_EQ(with_source(config, lip6 + "@20s").input.truth_tolerance_frames, 10);
}

TEST_F(Protocols, WhatTheConfigSetsItselfStays) {
  pipeline::Config config = pipeline::profile("paper");
  config.retrieve.window_frames = 3;
  config.input.truth_tolerance_frames = 0;
  const pipeline::Config same = with_source(config, (folder_.root() / "Lip6Indoor").string());
  EXPECT_EQ(same.retrieve.window_frames, 3);
  EXPECT_EQ(same.input.truth_tolerance_frames, 0);
  config.retrieve.window_frames = -1;
  config.retrieve.window_s = 12.0;
  EXPECT_EQ(with_source(config, (folder_.root() / "Lip6Indoor").string()).retrieve.window_s, 12.0);
}

TEST_F(Protocols, QueriesWithALoopAreThoseOutsideTheWindow) {
  core::PlaceTruthMatrix places{4, {}};
  places.values.resize(16, core::PlaceTruth::kDifferent);
  for (const int at : {1 * 4 + 0, 3 * 4 + 0, 0 * 4 + 3})
    places.values[at] = core::PlaceTruth::kSame;
  EXPECT_EQ(num_queries_with_loop(places, 0), 2);
  EXPECT_EQ(num_queries_with_loop(places, 1), 1);
  EXPECT_EQ(num_queries_with_loop(places, 3), 0);
}

TEST_F(Protocols, WhatADownloadLacksIsTold) {
  const Protocol protocol = *protocol_of(folder_.root() / "hololens");
  core::Truth truth;
  EXPECT_THAT(missing_of(protocol, {.num_frames = 300}, truth),
              ElementsAre("73 of 373 images", "depth",
                          "truth of places: same_place.pgm, or depth and true poses",
                          "true poses: poses.txt"));
  truth.places.emplace();
  truth.trajectory.resize(1);
  EXPECT_THAT(missing_of(protocol, {.num_frames = 373, .has_depth = true}, truth), ElementsAre());
}

TEST_F(Protocols, DataSetsAreFoundInAFixedOrder) {
  folder_.write("sets/z/hololens/same_place.pgm", "");
  folder_.write("sets/OpenLORIS/cafe1-1/sensors.yaml", "");
  folder_.write("sets/OpenLORIS/cafe1-1/color.txt", "");
  folder_.write("sets/OpenLORIS/cafe1-1/groundtruth.txt", "");  // and depth
  folder_.write("sets/b/rtabmap_corridor/same_place.txt", "0\n");
  folder_.write("sets/NewCollege/masks/NewCollegeGroundTruth.mat", "");
  folder_.write("sets/Lip6Indoor/Images/lip6kennedy_bigdoubleloop_000000.ppm", "");  // no truth
  folder_.write("sets/GardensPoint/day_left/Image000.jpg", "");
  folder_.write("sets/GardensPoint/day_right/Image000.jpg", "");
  folder_.write("sets/1/2/3/4/hololens/same_place.pgm", "");  // too deep
  std::filesystem::create_symlink("/nowhere/at/all", folder_.at("sets/dangling"));
  const std::filesystem::path root = folder_.root() / "sets";
  EXPECT_THAT(find_data_sets(root),
              ElementsAre(root / "NewCollege", root / "GardensPoint", root / "OpenLORIS/cafe1-1",
                          root / "b/rtabmap_corridor", root / "z/hololens"));
  EXPECT_THROW(find_data_sets(root / "gone"), core::InputError);
}

TEST_F(Protocols, WithoutASourceTheDataSetsAndFourRenderedSequencesAreMeasured) {
  folder_.write("sets/rtabmap_corridor/same_place.txt", "0\n");
  const std::vector<std::string> sources = default_sources(folder_.root() / "sets");
  ASSERT_EQ(sources.size(), 5u);
  EXPECT_EQ(sources.front(), folder_.at("sets/rtabmap_corridor").string());
  EXPECT_EQ(sources[1], "twin:twin-corridors?seed=1000@10s");
  EXPECT_EQ(default_sources("").size(), 4u);
  EXPECT_TRUE(twin::is_twin_spec(with_source({}, quick_source()).source));
}

}  // namespace
}  // namespace samewhere::paper
