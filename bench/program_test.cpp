#include "program.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::bench {
namespace {

std::function<void()> say(CLI::App& app) {
  app.name("say");
  const auto word = std::make_shared<std::string>();
  app.add_option("WORD", *word)->required();
  return [word] {
    if (*word == "bad") throw core::InputError("bad: expected good");
    if (*word == "bug") throw std::logic_error("a bug");
  };
}

std::function<void()> fail(CLI::App&) { throw std::logic_error("not even set up"); }

int exit_code_of(SetUp set_up, std::vector<std::string> words) {
  words.insert(words.begin(), "say");
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  return run_program(static_cast<int>(arguments.size()), arguments.data(), set_up);
}

TEST(Program, TheExitCodeSaysWhatKindOfEndItWas) {
  EXPECT_EQ(exit_code_of(say, {"good"}), 0);
  EXPECT_EQ(exit_code_of(say, {"--help"}), 0);
  EXPECT_EQ(exit_code_of(say, {}), 2);
  EXPECT_EQ(exit_code_of(say, {"good", "--loud"}), 2);
  EXPECT_EQ(exit_code_of(say, {"bad"}), 2);
  EXPECT_EQ(exit_code_of(say, {"bug"}), 3);
  EXPECT_EQ(exit_code_of(fail, {"good"}), 3);
}

}  // namespace
}  // namespace samewhere::bench
