// `samewhere compare`, and what stderr shows on a terminal.

#include <gmock/gmock.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Compare : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  Outcome compared(const std::string& arguments) const {
    return run_program("compare " + arguments, folder_.root());
  }

  input::TestFolder folder_;
};

TEST_F(Compare, WritesOnePageOfSeveralRunsAndTellsWhatItCannotRead) {
  for (const char* name : {"a", "b"}) {
    const Outcome run = run_program(
        "run 'twin:office-loop?seed=2' --set twin.num_frames=6 --out " + quoted(path(name)),
        folder_.root());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const std::string both = quoted(path("a")) + " " + quoted(path("b"));
  const std::string page = " --out " + quoted(path("both.html"));
  const Outcome made = compared(both + page);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("frames with a measured pose"));
  EXPECT_THAT(core::read_file(path("both.html")), HasSubstr("<title>a and b</title>"));

  const Outcome again = compared(both + page);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("is there already"));
  EXPECT_EQ(compared(both + page + " --force --names before,after").exit_code, 0);
  EXPECT_THAT(core::read_file(path("both.html")), HasSubstr("<title>before and after</title>"));

  const Outcome named = compared(both + page + " --force --names one");
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_THAT(named.err, HasSubstr("--names: 1 names for 2 runs; expected one for each"));

  core::write_file(path("b") / "report.html", "<html></html>");
  const Outcome damaged = compared(both + page + " --force");
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("report.html: has no block `run`; expected the report.html"));
  EXPECT_THAT(core::read_file(path("both.html")), HasSubstr("before and after"));
}

// What a terminal of 60 columns shows of a command; the standard output of `script` is its screen.
std::string on_terminal(const std::string& environment, const std::string& arguments,
                        const std::filesystem::path& scratch) {
  core::write_file(scratch / "command.sh", "stty columns 60\n" + environment +
                                               " exec '" SAMEWHERE_PROGRAM "' " + arguments + "\n");
  const std::filesystem::path screen = scratch / "screen.txt";
  const std::string command = "script -qec \"bash " + quoted(scratch / "command.sh") +
                              "\" /dev/null </dev/null >" + quoted(screen);
  EXPECT_NE(std::system(command.c_str()), -1);
  return core::read_file(screen);
}

TEST_F(Compare, ATerminalShowsErrorsInRedAndAProgressLineThatFitsIt) {
  const std::string missing = "run /missing";
  EXPECT_THAT(on_terminal("TERM=xterm", missing, folder_.root()), HasSubstr("\x1b[31msamewhere: "));
  EXPECT_THAT(on_terminal("TERM=dumb", missing, folder_.root()), Not(HasSubstr("\x1b[3")));
  EXPECT_THAT(on_terminal("NO_COLOR=1 TERM=xterm", missing, folder_.root()),
              Not(HasSubstr("\x1b[3")));
  const std::string shown = on_terminal(
      "TERM=xterm",
      "run 'twin:office-loop?seed=2' --set twin.num_frames=40 --out " + quoted(path("run")),
      folder_.root());
  const std::size_t last = shown.rfind("\x1b[2K[");
  ASSERT_NE(last, std::string::npos) << shown;
  const std::string line = shown.substr(last + 4, shown.find_first_of("\r\n", last) - last - 4);
  EXPECT_THAT(line, HasSubstr("frames 40/40"));
  EXPECT_EQ(line.size(), 59U) << "cut to the terminal: " << line;
}

}  // namespace
}  // namespace samewhere::test
