// Each command does what its help says.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>
#include <samewhere/report/html.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Commands : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  // The checksum of HOG, in 16 digits.
  std::string describer_of_doctor() const {
    const std::string before = "numbers, describer ";
    const std::string out = run("doctor").out;
    const std::size_t at = out.find(before);
    EXPECT_NE(at, std::string::npos) << out;
    return at == std::string::npos ? "" : out.substr(at + before.size(), 16);
  }

  // What stands after `label` in its row; the width of a table is that of its longest label.
  static std::string row_of(const std::string& text, const std::string& label) {
    const std::size_t at = text.find(label);
    if (at == std::string::npos) return "";
    const std::size_t begin = text.find_first_not_of(' ', at + label.size());
    return text.substr(begin, text.find('\n', begin) - begin);
  }

  input::TestFolder folder_;
};

TEST_F(Commands, TrainWordsWritesAVocabularyThatLoopsReads) {
  const std::string walk = "'twin:office-loop?seed=2' --set twin.num_frames=6";
  const Outcome grown = run(fmt::format("train words {} --step 2 --branching 4 --depth 3 --out {}",
                                        walk, quoted(path("mine.bin"))));
  ASSERT_EQ(grown.exit_code, 0) << grown.err;
  EXPECT_NE(grown.out.find("features in 3 pictures"), std::string::npos) << grown.out;
  EXPECT_NE(core::read_file(path("mine.json")).find("\"num_pictures\": 3"), std::string::npos);
  const std::string loops = fmt::format(
      "loops {} --profile default --set retrieve.window_frames=2 --set retrieve.num_candidates=1 "
      "--set retrieve.word_candidates=3 --out {} --set retrieve.vocabulary=",
      walk, quoted(path("out")));
  const Outcome found = run(loops + quoted(path("mine.bin")));
  EXPECT_EQ(found.exit_code, 0) << found.err;
  // of frames 3, 4 and 5: all older ones that the window allows
  EXPECT_EQ(row_of(found.out, "loop candidates"), "6");
  EXPECT_EQ(run("train words " + walk + " --out " + quoted(path("words.json"))).exit_code, 2);
  const Outcome missing = run(loops + "no.bin --force");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("retrieve.vocabulary = no.bin: there is no such file"),
            std::string::npos);
}

TEST_F(Commands, HelpShowsAnExampleOfEach) {
  EXPECT_EQ(run("--help").exit_code, 0);
  for (const std::string command : {"run", "loops", "eval", "dense", "export", "bench", "twin",
                                    "map", "config", "calibrate", "doctor", "train words"}) {
    const Outcome help = run(command + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Example"), std::string::npos) << command;
    EXPECT_NE(help.out.find("samewhere " + command), std::string::npos) << command;
  }
  EXPECT_NE(run("--version").out.find("samewhere 0."), std::string::npos);
}

TEST_F(Commands, TrainSaysHowToBuildItWhereItIsMissing) {
  std::filesystem::copy_file(SAMEWHERE_PROGRAM, path("samewhere"));
  const std::string lonely =
      "'" + path("samewhere").string() + "' train --help 2>'" + path("err.txt").string() + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(lonely.c_str())), 2);
  const std::string complaint = core::read_file(path("err.txt"));
  EXPECT_NE(complaint.find("./run train"), std::string::npos) << complaint;
}

TEST_F(Commands, ConfigPrintsWhatConfigReads) {
  const Outcome printed = run("config --profile paper --set verify.min_inliers=77");
  ASSERT_EQ(printed.exit_code, 0);
  EXPECT_NE(printed.out.find("min_inliers: 77"), std::string::npos);
  core::write_file(path("mine.yaml"), printed.out);
  const Outcome again = run("config --config " + quoted(path("mine.yaml")));
  EXPECT_EQ(again.out, printed.out);
}

TEST_F(Commands, AnOldKeyIsRefusedWithItsNameNow) {
  const Outcome renamed = run("config --set track.lost.max_speed_m_s=1");
  EXPECT_EQ(renamed.exit_code, 2);
  EXPECT_NE(renamed.err.find("track.lost is now track.relocalization"), std::string::npos)
      << renamed.err;
}

TEST_F(Commands, TheCommittedConfigFilesAreWhatTheProgramHas) {
  const std::filesystem::path repository = SAMEWHERE_REPOSITORY;
  EXPECT_EQ(run("config").out, core::read_file(repository / "configs/default.yaml"))
      << "make it anew: samewhere config > configs/default.yaml";
  const std::string table = core::read_file(repository / "docs/config.md");
  EXPECT_NE(table.find(run("config --table").out), std::string::npos) << "make docs/config.md anew";
  const std::string expert = core::read_file(repository / "docs/config-expert.md");
  EXPECT_NE(expert.find(run("config --table --expert").out), std::string::npos)
      << "make docs/config-expert.md anew";
}

TEST_F(Commands, DoctorPrintsWhatAReportOfAFaultNeeds) {
  const Outcome doctor = run("doctor");
  ASSERT_EQ(doctor.exit_code, 0) << doctor.err;
  for (const char* row :
       {"samewhere ", "build ", "OpenCV ", "Eigen ", "Ceres ", "threads ", "networks run by ",
        "rendered pictures ", "image descriptor", "HOG", "descriptor ", " ms "}) {
    EXPECT_NE(doctor.out.find(row), std::string::npos) << row << "\n" << doctor.out;
  }
}

TEST_F(Commands, DoctorNamesANetworkThatCannotBeUsedAfterWhatItKnows) {
  core::write_file(path("net.onnx"), "no network");
  const Outcome doctor = run("doctor --set describe.method=autoencoder --set describe.network=" +
                             quoted(path("net.onnx")));
  EXPECT_EQ(doctor.exit_code, 2);
  EXPECT_NE(doctor.out.find("OpenCV"), std::string::npos);
  EXPECT_NE(doctor.err.find("net.onnx: is cut short or no ONNX file"), std::string::npos);
  EXPECT_EQ(std::count(doctor.err.begin(), doctor.err.end(), '\n'), 1) << doctor.err;
}

TEST_F(Commands, DoctorTimesEveryDescriberThereIs) {
  const auto num_described = [](const std::string& text) {
    std::size_t num = 0;
    for (std::size_t at = text.find("image descriptor"); at != std::string::npos;
         at = text.find("image descriptor", at + 1))
      ++num;
    return num;
  };
  EXPECT_EQ(num_described(run("doctor --set describe.network=nowhere.onnx").out), 1U);
  const bool is_shipped = std::filesystem::exists(SAMEWHERE_REPOSITORY "/models/autoencoder.onnx");
  EXPECT_EQ(num_described(run("doctor").out), is_shipped ? 2U : 1U);
}

TEST_F(Commands, RunEvalAndASecondRunAgree) {
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE"), 0);  // both are to render
  const std::string source = "'twin:office-loop?seed=2' --set twin.num_frames=12";
  const Outcome first = run("run " + source + " --out " + quoted(path("a")));
  ASSERT_EQ(first.exit_code, 0) << first.err;
  for (const char* file : {"trajectory.tum", "odometry.tum", "frames.csv", "loops.json", "map.ply",
                           "config.yaml", "timing.json", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(path("a") / file)) << file;
  }
  ASSERT_EQ(run("run " + source + " --out " + quoted(path("b"))).exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(path("a"))) {
    const auto name = entry.path().filename();
    if (name == "timing.json") continue;
    const auto content = [&](const std::filesystem::path& file) {
      const std::string text = core::read_file(file);
      return name == "report.html" ? report::without_durations(text) : text;
    };
    EXPECT_EQ(content(entry.path()), content(path("b") / name)) << name;
  }
  EXPECT_NE(first.out.find(describer_of_doctor() + ", hog"), std::string::npos) << first.out;
  const Outcome eval = run("eval " + quoted(path("a")));
  EXPECT_EQ(eval.exit_code, 0) << eval.err;
  const std::string figure = row_of(eval.out, "ATE RMSE (median, max)");
  EXPECT_FALSE(figure.empty()) << eval.out;
  EXPECT_EQ(row_of(first.out, "ATE RMSE (median, max)"), figure);
  const Outcome stages = run("eval --stages " + quoted(path("a")));
  EXPECT_EQ(stages.exit_code, 0) << stages.err;
  EXPECT_TRUE(row_of(stages.out, "track").starts_with("12 ")) << stages.out;
}

TEST_F(Commands, LoopsWritesTheFilesThatOthersRead) {
  const Outcome outcome =
      run("loops 'twin:office-loop?seed=2' --set twin.num_frames=8 --set retrieve.window_frames=2 "
          "--out " +
          quoted(path("loops")));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string matches = core::read_file(path("loops") / "matches.txt");
  EXPECT_EQ(std::count(matches.begin(), matches.end(), '\n'), 5) << "queries 3 to 7\n" << matches;
  EXPECT_TRUE(std::filesystem::exists(path("loops") / "accepted.txt"));
  EXPECT_TRUE(std::filesystem::exists(path("loops") / "loops.json"));
  EXPECT_NE(outcome.out.find("AUC"), std::string::npos);
  EXPECT_NE(outcome.out.find(describer_of_doctor() + ", hog"), std::string::npos) << outcome.out;
  EXPECT_EQ(run("eval " + quoted(path("loops"))).exit_code, 0);
}

TEST_F(Commands, LoopsAcceptNothingByAppearanceAloneUnlessNoPlacesLookAlike) {
  const std::string walk =
      "loops 'twin:office-loop?seed=2&camera=mono' --set twin.num_frames=8 --set "
      "retrieve.window_frames=2 --out ";
  const Outcome waiting = run(walk + quoted(path("waiting")));
  ASSERT_EQ(waiting.exit_code, 0) << waiting.err;
  EXPECT_THAT(waiting.out,
              HasSubstr("5 frames match an earlier one, and appearance alone accepts nothing"));
  EXPECT_EQ(core::read_file(path("waiting") / "accepted.txt").size(), 0U);
  const Outcome alone = run(walk + quoted(path("alone")) + " --prior unique");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_THAT(alone.out, Not(HasSubstr("appearance alone")));
  EXPECT_GT(core::read_file(path("alone") / "accepted.txt").size(), 0U);
}

TEST_F(Commands, WithoutOutNothingIsOverwritten) {
  const std::string in_scratch =
      "cd " + quoted(folder_.root()) + " && '" + SAMEWHERE_PROGRAM +
      "' loops 'twin:office-loop?seed=2' --set twin.num_frames=2 >/dev/null 2>&1";
  ASSERT_EQ(std::system(in_scratch.c_str()), 0);
  ASSERT_EQ(std::system(in_scratch.c_str()), 0);
  int num_folders = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path("runs")))
    ++num_folders;
  EXPECT_EQ(num_folders, 2);
}

TEST_F(Commands, CtrlCFinishesTheFilesAndIsExitCode130) {
  const Outcome cut = interrupt_program(
      "run 'twin:office-loop?seed=2' --set twin.num_frames=120 --out " + quoted(path("cut")),
      "[ -e " + quoted(path("cut/map.sw")) + " ]", folder_.root());
  EXPECT_EQ(cut.exit_code, 130) << cut.err;
  for (const char* file :
       {"trajectory.tum", "frames.csv", "loops.json", "map.ply", "config.yaml", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(path("cut") / file)) << file;
  }
  const Outcome eval = run("eval " + quoted(path("cut")));
  EXPECT_EQ(eval.exit_code, 0) << eval.err;
}

}  // namespace
}  // namespace samewhere::test
