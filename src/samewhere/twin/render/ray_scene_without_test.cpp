// Of a build with -DSAMEWHERE_TWIN=OFF alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

template <class Function>
std::string error_of(Function function) {
  try {
    function();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

TEST(RaySceneWithout, SaysThatNothingCanBeRendered) {
  EXPECT_FALSE(can_render());
  EXPECT_THAT(error_of([] { RayScene({}); }), testing::HasSubstr("SAMEWHERE_TWIN=OFF"));
}

TEST(RaySceneWithout, AWalkNamesItsSourceAndWhatToUseInstead) {
  EXPECT_THAT(error_of([] { Walkthrough(Spec{.preset = "office-loop"}, Config{}); }),
              testing::AllOf(testing::StartsWith("twin:office-loop: built without"),
                             testing::HasSubstr("expected a recording")));
}

}  // namespace
}  // namespace samewhere::twin
