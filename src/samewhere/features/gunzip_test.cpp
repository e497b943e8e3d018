#include <gmock/gmock.h>

#include <samewhere/features/gunzip.hpp>
#include <samewhere/features/test_foreign_files.hpp>

namespace samewhere::features {
namespace {

using testing::HasSubstr;

class Gunzip : public ForeignFiles {
 protected:
  static std::string complaint_of(const std::string& bytes) {
    try {
      gunzip(bytes, {.num_bytes = 100'000, .kind = "a test"}, "some.gz");
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }
};

TEST_F(Gunzip, GivesBackWhatWasCompressed) {
  const std::string text(50'000, 'x');
  EXPECT_TRUE(looks_like_gzip(gzip(text)));
  EXPECT_FALSE(looks_like_gzip(text));
  EXPECT_EQ(gunzip(gzip(text), core::kNetworkLimit, "some.gz"), text);
}

TEST_F(Gunzip, RefusesWhatIsCutShortDamagedOrGrowsPastTheLimit) {
  const std::string packed = gzip(std::string(50'000, 'x'));
  EXPECT_EQ(complaint_of(packed), "none");
  EXPECT_THAT(complaint_of(packed.substr(0, packed.size() / 2)),
              HasSubstr("some.gz: is cut short"));
  EXPECT_THAT(complaint_of("\x1f\x8b and no more of it"), HasSubstr("cut short or damaged"));
  EXPECT_THAT(complaint_of(gzip(std::string(50'000'000, 'x'))), HasSubstr("more than the 100000"));
}

}  // namespace
}  // namespace samewhere::features
