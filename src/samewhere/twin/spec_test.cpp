#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/spec.hpp>

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
        BadSpec{"twin:", "unknown preset ; expected one of: office-loop"},
        BadSpec{"twin:office-lop", "unknown preset office-lop; expected one of: office-loop"},
        BadSpec{"twin:office-loop?sed=3", "unknown key sed; expected one of: seed, similarity"},
        BadSpec{"twin:office-loop?seed", "expected key=value, found \"seed\""},
        BadSpec{"twin:office-loop?", "expected key=value, found \"\""},
        BadSpec{"twin:office-loop?seed=", "seed =  is not a whole number"},
        BadSpec{"twin:office-loop?seed=-1", "seed = -1 is not a whole number"},
        BadSpec{"twin:office-loop?seed=3.5", "seed = 3.5 is not a whole number"},
        BadSpec{"twin:office-loop?seed=99999999999999999999", "is not a whole number"},
        BadSpec{"twin:office-loop?similarity=1.1", "similarity = 1.1 is not a number in [0, 1]"},
        BadSpec{"twin:office-loop?similarity=nan", "similarity = nan is not a number in [0, 1]"},
        BadSpec{"twin:office-loop?seed=1&seed=2", "seed given twice"},
        BadSpec{"office-loop", "expected twin:PRESET"}));

}  // namespace
}  // namespace samewhere::twin
