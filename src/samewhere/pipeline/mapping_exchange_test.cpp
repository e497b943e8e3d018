#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/mapping_exchange.hpp>

namespace samewhere::pipeline {
namespace {

// Mapping adds a keyframe to its map at each message that asks for one.
class MappingExchangeTest : public testing::Test {
 protected:
  static constexpr int kVisibleAfter = 3;

  void serve(const ToMapping& message, const MappingLink::Reply& reply) {
    if (std::holds_alternative<SaveFrames>(message)) return;
    if (!std::holds_alternative<FindPlace>(message)) {
      const int frame = static_cast<int>(map_.keyframes.size());
      map_ = apply(map_, map::start_map(map_, features::test_view(world_, frame, {}), {}));
    }
    reply({.map = map_, .places = {}});
  }

  void insert(std::size_t frame) {
    scene::TrackedView tracked;
    tracked.view.frame = core::FrameId(frame);
    exchange_.insert(tracked, {}, {});
  }

  features::TestWorld world_ = features::test_world(5);
  scene::MapVersion map_;
  core::DirectLink<ToMapping, MapAnswer> link_{
      [this](const ToMapping& message, const MappingLink::Reply& reply) { serve(message, reply); }};
  MappingExchange exchange_{link_, kVisibleAfter, 0};
};

TEST_F(MappingExchangeTest, AKeyframeIsDueSomeFramesLater) {
  exchange_.initialize(StartMap{});
  EXPECT_FALSE(exchange_.is_due(100)) << "none is in progress";
  insert(10);
  EXPECT_TRUE(exchange_.is_keyframe(core::FrameId(10)));
  EXPECT_FALSE(exchange_.is_due(10 + kVisibleAfter - 1));
  EXPECT_TRUE(exchange_.is_due(10 + kVisibleAfter));
  const auto [id, map] = exchange_.receive();
  EXPECT_EQ(id, core::KeyframeId(1));
  EXPECT_EQ(map.keyframes.size(), 2U);
  EXPECT_FALSE(exchange_.is_keyframe_in_progress());
}

TEST_F(MappingExchangeTest, OneKeyframeIsInProgressAtMost) {
  exchange_.initialize(StartMap{});
  EXPECT_THROW(exchange_.receive(), core::ContractError);
  insert(10);
  EXPECT_THROW(insert(11), core::ContractError);
  EXPECT_THROW(exchange_.initialize(StartMap{}), core::ContractError);
}

TEST_F(MappingExchangeTest, AnotherInitializationDiscardsTheKeyframesBefore) {
  exchange_.initialize(StartMap{});
  insert(10);
  exchange_.receive();
  EXPECT_EQ(exchange_.num_keyframes_of_map(), 2U);
  exchange_.initialize(StartMap{});
  EXPECT_EQ(exchange_.num_keyframes(), 3U);
  EXPECT_EQ(exchange_.num_keyframes_of_map(), 1U);
  EXPECT_FALSE(exchange_.is_keyframe(core::FrameId(10)));
}

TEST_F(MappingExchangeTest, PlacesAreDueSomeFramesAfterTheyWereAskedFor) {
  exchange_.initialize(StartMap{});
  features::View view;
  view.frame = core::FrameId(20);
  EXPECT_FALSE(exchange_.are_places_due(100)) << "none were asked for";
  exchange_.ask_places(view, {});
  EXPECT_FALSE(exchange_.are_places_due(21));
  EXPECT_TRUE(exchange_.are_places_due(30));
  EXPECT_THROW(exchange_.ask_places(view, {}), core::ContractError);
  EXPECT_EQ(exchange_.receive_places().map.keyframes.size(), 1U);
  EXPECT_FALSE(exchange_.are_places_asked());
}

TEST_F(MappingExchangeTest, AQuestionThatWaitsDropsPlacesThatAreNotDue) {
  exchange_.initialize(StartMap{});
  exchange_.ask_places({}, {});
  insert(10);
  EXPECT_FALSE(exchange_.are_places_asked());
  EXPECT_EQ(exchange_.receive().map.keyframes.size(), 2U) << "the answer to the keyframe";
  exchange_.ask_places({}, {});
  EXPECT_EQ(exchange_.initialize(StartMap{}).keyframes.size(), 3U);
}

TEST_F(MappingExchangeTest, SavedFramesHaveNoAnswer) {
  exchange_.initialize(StartMap{});
  exchange_.save({});
  EXPECT_EQ(exchange_.find_places({}, {}).map.keyframes.size(), 1U);
}

}  // namespace
}  // namespace samewhere::pipeline
