#include <gmock/gmock.h>

#include <samewhere/features/fbow_vocabulary.hpp>
#include <samewhere/features/test_foreign_files.hpp>

namespace samewhere::features {
namespace {

using testing::HasSubstr;

class FbowVocabulary : public ForeignFiles {
 protected:
  // The file with other bytes at a place.
  template <class T>
  std::string with(std::size_t at, T value) const {
    std::string bytes = fbow();
    put(bytes, at, value);
    return bytes;
  }
};

TEST_F(FbowVocabulary, IsReadAsItWasWritten) { expect_same(load(fbow())); }

TEST_F(FbowVocabulary, CutShortIsRefused) {
  const std::string whole = fbow();
  for (const std::size_t size :
       {std::size_t{8}, std::size_t{127}, std::size_t{128}, whole.size() / 2, whole.size() - 1})
    EXPECT_THAT(complaint(whole.substr(0, size)), HasSubstr("cut short")) << size;
}

TEST_F(FbowVocabulary, SizesThatDoNotFitAreRefusedBeforeMemoryIsTaken) {
  constexpr std::uint64_t kHuge = ~std::uint64_t{0} / 4;
  for (const std::size_t at : {72, 80, 88, 96, 104})
    EXPECT_THAT(complaint(with(at, kHuge)), HasSubstr("cut short or damaged")) << at;
  for (const std::size_t at : {64, 120})
    EXPECT_THAT(complaint(with(at, 0xFFFF'FFFFU)), HasSubstr("cut short or damaged")) << at;
  EXPECT_THAT(complaint(with(80, std::uint64_t{0})), HasSubstr("cut short or damaged"));
  EXPECT_THAT(complaint(with(116, 64)), HasSubstr("descriptors of 64 bytes"));
  EXPECT_THAT(complaint(with(112, 5)), HasSubstr("type 5"));
}

TEST_F(FbowVocabulary, BlocksThatAreNoTreeAreRefused) {
  constexpr std::size_t kRootChild = 128 + 8 + 96;
  EXPECT_THAT(complaint(with(kRootChild, 0U)), HasSubstr("second parent of block 0")) << "a cycle";
  EXPECT_THAT(complaint(with(kRootChild, 0x7FFF'FFFFU)), HasSubstr("second parent of block"));
  EXPECT_THAT(complaint(with(128, std::uint16_t{0xFFFF})), HasSubstr("65535 children"));
  EXPECT_THAT(complaint(with(128, std::uint16_t{0})), HasSubstr("without words"));
  std::string word = with(kRootChild, 0x8000'0000U);
  put(word, kRootChild + 4, std::nanf(""));
  EXPECT_THAT(complaint(word), HasSubstr("0 or more"));
}

}  // namespace
}  // namespace samewhere::features
