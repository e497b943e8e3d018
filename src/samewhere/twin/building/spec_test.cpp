#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::twin {
namespace {

std::string refusal_of(const std::string& text) {
  try {
    parse_spec(text);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TwinSpec, IsRecognisedByItsScheme) {
  EXPECT_TRUE(is_twin_spec("twin:office-loop"));
  EXPECT_FALSE(is_twin_spec("/data/twin:office-loop"));
  EXPECT_FALSE(is_twin_spec("twins"));
  EXPECT_FALSE(is_twin_spec(""));
}

TEST(TwinSpec, ReadsPresetSeedAndSimilarity) {
  const Spec spec = parse_spec("twin:office-loop?seed=3&similarity=0.9");
  EXPECT_EQ(spec.preset, "office-loop");
  EXPECT_EQ(spec.seed, 3U);
  EXPECT_DOUBLE_EQ(spec.similarity, 0.9);
}

TEST(TwinSpec, HasDefaultsForWhatIsNotSaid) {
  const Spec spec = parse_spec("twin:office-loop");
  EXPECT_EQ(spec.seed, 1U);
  EXPECT_DOUBLE_EQ(spec.similarity, 0.8);
}

TEST(TwinSpec, ReadsHowTheBuildingIsWalked) {
  const Spec spec = parse_spec("twin:hotel?speed=0.5&people=7&camera=stereo&stray=0.6");
  EXPECT_EQ(spec.preset, "hotel");
  EXPECT_DOUBLE_EQ(spec.stray_m, 0.6);
  EXPECT_EQ(parse_spec("twin:hotel").stray_m, 0.0);
  EXPECT_DOUBLE_EQ(spec.speed, 0.5);
  EXPECT_EQ(spec.people, 7);
  EXPECT_EQ(spec.sensors, Sensors::kStereo);
}

TEST(TwinSpec, EveryListedPresetCanBeAskedFor) {
  EXPECT_EQ(list_presets().size(), 8U);
  for (const auto& preset : list_presets()) {
    EXPECT_EQ(parse_spec("twin:" + std::string(preset.name)).preset, preset.name);
    EXPECT_FALSE(preset.what.empty()) << preset.name;
  }
}

TEST(TwinSpec, EqualSpecsHaveOneCanonicalText) {
  const std::string text = canonical_text(parse_spec("twin:mirror?speed=1.50&seed=007"));
  EXPECT_EQ(text, "twin:mirror?seed=7&similarity=0.8&speed=1.5&people=0&camera=rgbd");
  EXPECT_EQ(canonical_text(parse_spec("twin:mirror?seed=7&speed=1.5&people=0")), text);
  EXPECT_EQ(canonical_text(parse_spec(text)), text);
  EXPECT_NE(canonical_text(parse_spec("twin:mirror?seed=7&speed=1.5&camera=mono")), text);
  EXPECT_EQ(canonical_text(parse_spec("twin:mirror?seed=7&speed=1.5&stray=0")), text);
  const std::string astray = canonical_text(parse_spec("twin:mirror?stray=0.8&seed=7&speed=1.5"));
  EXPECT_EQ(astray, text + "&stray=0.8");
  EXPECT_EQ(canonical_text(parse_spec(astray)), astray);
  const std::string copied = canonical_text(parse_spec("twin:mirror?copy=2&seed=7&speed=1.5"));
  EXPECT_EQ(copied, text + "&copy=2");
  EXPECT_EQ(canonical_text(parse_spec(copied)), copied);
}

struct BadSpec {
  std::string text;
  std::string complaint;  // what the message must name
};

class TwinSpecRefusal : public testing::TestWithParam<BadSpec> {};

TEST_P(TwinSpecRefusal, NamesWhatIsWrongAndWhatWasExpected) {
  EXPECT_THAT(refusal_of(GetParam().text), testing::HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    All, TwinSpecRefusal,
    testing::Values(
        BadSpec{"twin:", "unknown preset ; expected one of: office-loop, twin"},
        BadSpec{"twin:office-lop", "unknown preset office-lop; expected one of: office-loop"},
        BadSpec{"twin:office-loop?sed=3",
                "unknown key sed; expected one of: seed, similarity, speed"},
        BadSpec{"twin:office-loop?seed", "expected key=value, found \"seed\""},
        BadSpec{"twin:office-loop?", "expected key=value, found \"\""},
        BadSpec{"twin:office-loop?seed=", "seed =  is not a whole number"},
        BadSpec{"twin:office-loop?seed=-1", "seed = -1 is not a whole number"},
        BadSpec{"twin:office-loop?seed=3.5", "seed = 3.5 is not a whole number"},
        BadSpec{"twin:office-loop?seed=99999999999999999999", "is not a whole number"},
        BadSpec{"twin:office-loop?similarity=1.1", "similarity = 1.1 is not a number in [0, 1]"},
        BadSpec{"twin:office-loop?similarity=nan", "similarity = nan is not a number in [0, 1]"},
        BadSpec{"twin:office-loop?speed=0.49", "speed = 0.49 is not a number in [0.5, 2]"},
        BadSpec{"twin:office-loop?speed=2.1", "speed = 2.1 is not a number in [0.5, 2]"},
        BadSpec{"twin:office-loop?copy=-1", "copy = -1 is not a whole number in [0, 1000]"},
        BadSpec{"twin:office-loop?stray=1.1", "stray = 1.1 is not a number in [0, 1]"},
        BadSpec{"twin:office-loop?people=31", "people = 31 is not a whole number in [0, 30]"},
        BadSpec{"twin:office-loop?people=-1", "people = -1 is not a whole number in [0, 30]"},
        BadSpec{"twin:office-loop?camera=rgb", "camera = rgb is not rgbd, stereo or mono"},
        BadSpec{"twin:office-loop?seed=1&seed=2", "seed given twice"},
        BadSpec{"office-loop", "expected twin:PRESET"}));

}  // namespace
}  // namespace samewhere::twin
