#include <gmock/gmock.h>

#include <samewhere/features/dbow2_vocabulary.hpp>
#include <samewhere/features/test_foreign_files.hpp>

namespace samewhere::features {
namespace {

using testing::HasSubstr;

class Dbow2Vocabulary : public ForeignFiles {};

const std::string kBytes32 = [] {
  std::string text;
  for (int i = 0; i < 32; ++i) text += "7 ";
  return text;
}();

std::string yaml_node(int id, int parent) {
  return fmt::format("- {{ nodeId:{}, parentId:{}, weight:1.,\n descriptor:\"{}\" }}\n", id, parent,
                     kBytes32);
}

std::string yaml_of(const std::string& nodes, const std::string& words) {
  return "%YAML:1.0\n---\nvocabulary:\n k: 10\n L: 6\n nodes:\n" + nodes + " words:\n" + words;
}

TEST_F(Dbow2Vocabulary, TextAndYamlPlainAndCompressedAreOneVocabulary) {
  for (const std::string& file : {dbow2_text(), dbow2_yaml()}) {
    expect_same(load(file));
    expect_same(load(gzip(file)));
  }
}

TEST_F(Dbow2Vocabulary, TextThatIsCutShortOrDamagedIsRefused) {
  const std::string whole = dbow2_text();
  for (std::size_t size = 60; size + 8 < whole.size(); size += 997)
    EXPECT_THAT(complaint(whole.substr(0, size)), HasSubstr("cut short or damaged")) << size;
  EXPECT_THAT(complaint("3 4 0 0\n"), HasSubstr("without words"));
  EXPECT_THAT(complaint("3 99 0 0\n"), HasSubstr("L from 1 to 20"));
  EXPECT_THAT(complaint("1000000000 4 0 0\n"), HasSubstr("k from 2 to 100"));
  const std::string leaf = " 1 " + kBytes32 + "1.5\n";
  EXPECT_THAT(complaint("3 4 0 0\n1" + leaf), HasSubstr("line 2")) << "a node that is its parent";
  EXPECT_THAT(complaint("3 4 0 0\n-1" + leaf), HasSubstr("line 2"));
  EXPECT_THAT(complaint("3 4 0 0\n0 1 " + kBytes32 + "nan\n"), HasSubstr("0 or more"));
  EXPECT_THAT(complaint("3 4 0 0\n0 1 " + kBytes32 + "-1\n"), HasSubstr("0 or more"));
  EXPECT_THAT(complaint("3 4 0 0\n0 1 256 " + kBytes32 + "1\n"), HasSubstr("line 2"));
  EXPECT_THAT(complaint("3 4 0 0\n0" + leaf + "1" + leaf), HasSubstr("has children"));
  EXPECT_THAT(complaint("2 4 0 0\n0" + leaf + "0" + leaf + "0" + leaf), HasSubstr("3 children"));
  EXPECT_THAT(complaint("2 1 0 0\n0 0 " + kBytes32 + "0\n1" + leaf), HasSubstr("more levels"));
}

TEST_F(Dbow2Vocabulary, YamlThatIsCutShortOrDamagedIsRefused) {
  const std::string whole = dbow2_yaml();
  for (std::size_t size = 100; size + 8 < whole.size(); size += 997)
    EXPECT_NE(complaint(whole.substr(0, size)), "none") << size;
  const std::string word_1 = "- { wordId:0, nodeId:1 }\n";
  EXPECT_EQ(complaint(yaml_of(yaml_node(1, 0), word_1)), "none");
  EXPECT_THAT(complaint(yaml_of(yaml_node(1, 0) + yaml_node(2, 3) + yaml_node(3, 2), word_1)),
              HasSubstr("2 of its 4 nodes are not below the root"))
      << "a cycle";
  EXPECT_THAT(complaint(yaml_of(yaml_node(2000000000, 0), word_1)),
              HasSubstr("beyond its 1 nodes"));
  EXPECT_THAT(complaint(yaml_of(yaml_node(1, 0) + yaml_node(1, 0), word_1)),
              HasSubstr("second node of nodeId 1"));
  EXPECT_THAT(complaint(yaml_of(yaml_node(1, 99), word_1)), HasSubstr("has the parent 99"));
  EXPECT_THAT(complaint(yaml_of(yaml_node(1, 0), "- { wordId:0, nodeId:7 }\n")),
              HasSubstr("nodeId of a node"));
  EXPECT_THAT(complaint(yaml_of(yaml_node(1, 0), "")), HasSubstr("is no word"));
  EXPECT_THAT(complaint("%YAML:1.0\n---\nother: 1\n"), HasSubstr("no DBoW2 vocabulary"));
  EXPECT_THAT(complaint("%YAML:1.0\nvocabulary:\n" + std::string(100000, '[')),
              HasSubstr("no DBoW2 vocabulary"));
}

TEST_F(Dbow2Vocabulary, AnotherTextIsNone) {
  EXPECT_THAT(complaint("ten words to be read"), HasSubstr("is no vocabulary"));
  EXPECT_THAT(complaint(""), HasSubstr("is no vocabulary"));
}

}  // namespace
}  // namespace samewhere::features
