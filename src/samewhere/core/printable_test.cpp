#include <gtest/gtest.h>

#include <samewhere/core/printable.hpp>

namespace samewhere::core {
namespace {

TEST(Printable, LettersOfUtf8Stay) {
  const std::string words = "Küche, кухня, 台所, 🙂";
  EXPECT_EQ(printable_line(words, 100), words);
  EXPECT_EQ(printable_text("a\tb\nc\n"), "a\tb\nc\n");
}

TEST(Printable, WhatMovesACursorIsAQuestionMark) {
  EXPECT_EQ(printable_line("a\x1b[2Jb\r\n\tc\x7f", 100), "a?[2Jb???c?");
  EXPECT_EQ(printable_line("\u009b31m", 100), "?31m") << "C1, in UTF-8";
  EXPECT_EQ(printable_line("\x9b"
                           "31m",
                           100),
            "?31m")
      << "C1, in one byte";
  EXPECT_EQ(printable_line(std::string("a\0b", 3), 100), "a?b");
  EXPECT_EQ(printable_text("a\x1b]0;title\x07\n"), "a?]0;title?\n");
}

TEST(Printable, WhatTurnsOrHidesTextIsAQuestionMark) {
  EXPECT_EQ(printable_line("gnp.\u202eexe", 100), "gnp.?exe");
  EXPECT_EQ(printable_line("a\u2066b\u200fc\u2028d\ufeff", 100), "a?b?c?d?");
}

TEST(Printable, BytesThatAreNoUtf8AreQuestionMarks) {
  EXPECT_EQ(printable_line("\xff\xfe", 100), "??");
  EXPECT_EQ(printable_line("a\xc3", 100), "a?") << "cut short";
  EXPECT_EQ(printable_line("\xc0\xaf", 100), "??") << "too long a form";
  EXPECT_EQ(printable_line("\xed\xa0\x80", 100), "???") << "half a surrogate";
  EXPECT_EQ(printable_line("\xf4\x90\x80\x80", 100), "????") << "beyond the last letter";
}

TEST(Printable, ALongLineIsCutInTheMiddle) {
  const std::string text = "rgb.txt: " + std::string(1'000'000, 'x') + "; expected a number";
  const std::string line = printable_line(text, 300);
  EXPECT_LT(line.size(), 350U);
  EXPECT_TRUE(line.starts_with("rgb.txt: xxx"));
  EXPECT_TRUE(line.ends_with("; expected a number"));
  EXPECT_NE(line.find("bytes left out"), std::string::npos);
}

TEST(Printable, ACutSplitsNoLetter) {
  std::string text;
  for (int i = 0; i < 200; ++i) text += "台";
  for (std::size_t most = 30; most < 40; ++most)
    EXPECT_EQ(printable_line(text, most).find('?'), std::string::npos) << most;
}

}  // namespace
}  // namespace samewhere::core
