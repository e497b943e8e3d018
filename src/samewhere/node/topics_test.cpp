#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/node/config.hpp>
#include <samewhere/node/topics.hpp>

namespace samewhere::node {
namespace {

TEST(TopicNames, AreInTheNamespaceUnlessTheyBeginWithASlash) {
  const TopicNames names("/robot/", {});
  EXPECT_EQ(names.name_of("image"), "/robot/image");
  EXPECT_EQ(names.name_of("/tf"), "/tf");
  EXPECT_EQ(TopicNames("", {}).name_of("image"), "/image");
}

TEST(TopicNames, AreRemapped) {
  const TopicNames names("robot", {"image:=/cam0/image_raw", "/tf:=tf", "depth/compressed:=d"});
  EXPECT_EQ(names.name_of("image"), "/cam0/image_raw");
  EXPECT_EQ(names.name_of("image/compressed"), "/cam0/image_raw/compressed");
  EXPECT_EQ(names.name_of("depth/compressed"), "/robot/d");
  EXPECT_EQ(names.name_of("/tf"), "/robot/tf");
  for (const char* text : {"image", ":=a", "image:="})
    EXPECT_THROW(TopicNames("", {text}), core::InputError) << text;
}

TEST(NodeConfig, IsPartedFromTheSettingsOfSlam) {
  const auto [config, settings] =
      config_from({"node.cameras=stereo", "verify.prior=unique", "node.map_frame=world"});
  EXPECT_EQ(config.cameras, Cameras::kStereo);
  EXPECT_EQ(config.map_frame, "world");
  EXPECT_EQ(settings, std::vector<std::string>{"verify.prior=unique"});
  EXPECT_THROW(config_from({"node.queue_frames=0"}), core::InputError);
  EXPECT_THROW(config_from({"node.no_such_key=0"}), core::InputError);
}

}  // namespace
}  // namespace samewhere::node
