#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/link.hpp>
#include <samewhere/pipeline/mapping.hpp>
#include <samewhere/pipeline/test_rooms.hpp>

namespace samewhere::pipeline {
namespace {

// Mapping of the map so far, with a stage of loop closing that a test speaks for.
class MappingInRooms : public LookAlikeRooms {
 protected:
  // Loop closing accepts these, one each time that it is asked for what waits.
  scene::MapVersion at_the_end(std::vector<scene::LoopEdge> accepted) {
    core::DirectLink<ToLoopClosing, LoopAnswer> loops(
        [&](const ToLoopClosing& message, const LoopLink::Reply& reply) {
          const auto* question = std::get_if<AskAgain>(&message);
          ASSERT_NE(question, nullptr);
          num_loops_asked_.push_back(question->map.loops.size());
          LoopAnswer answer{.map_number = question->map.number};
          if (!accepted.empty()) {
            const core::CandidateId id = accepted.front().cause;
            answer.loops.push_back({.edge = accepted.front()});
            answer.rows.push_back({{.id = id}, core::LoopClosure{.candidate = id}});
            accepted.erase(accepted.begin());
          }
          reply(answer);
        });
    core::DirectLink<BundleAll, scene::Edit> bundling(
        [](const BundleAll& /*message*/, const BundleLink::Reply& reply) { reply({}); });
    Mapping mapping(config_, map_, {loops, bundling}, {});
    mapping.take(ToMapping(EndOfInput{}), {});
    return mapping.map();
  }

  std::vector<std::size_t> num_loops_asked_;  // loops of the map at each question
};

TEST_F(MappingInRooms, AtTheEndWaitingCandidatesAreAskedUntilNoneIsAccepted) {
  const auto after = at_the_end({true_loop(5, 0), true_loop(11, 6)});
  EXPECT_EQ(after.loops.size(), 2U);
  EXPECT_EQ(num_loops_asked_, (std::vector<std::size_t>{0, 1, 2}));
}

TEST_F(MappingInRooms, NoneIsAskedWhereNoLoopsAreClosed) {
  config_.close_loops = false;
  EXPECT_TRUE(at_the_end({true_loop(5, 0)}).loops.empty());
  EXPECT_TRUE(num_loops_asked_.empty());
}

}  // namespace
}  // namespace samewhere::pipeline
