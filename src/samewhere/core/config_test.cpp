#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/config.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::core {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

enum class Search { kExact, kSampled };

struct Sampling {
  int num_draws = 50;
  bool with_pause = true;
};

struct Retrieve {
  double min_similarity = 0.6;
  Search search = Search::kExact;
  Sampling sampling;
};

struct Settings {
  int seed = 1;
  std::string label = "office";
  Retrieve retrieve;
};

void visit_fields(Sampling& c, FieldVisitor& visit) {
  visit("num_draws", c.num_draws, {.help = "draws per query", .min = 1});
  visit("with_pause", c.with_pause, {.help = "pause after a loop"});
}

void visit_fields(Retrieve& c, FieldVisitor& visit) {
  visit("min_similarity", c.min_similarity, {.help = "cosine", .min = -1.0, .max = 1.0});
  visit("search", c.search, {.help = "how", .choices = {"exact", "sampled"}});
  visit("sampling", c.sampling, {.help = "Sampled search"});
}

void visit_fields(Settings& c, FieldVisitor& visit) {
  visit("seed", c.seed, {.help = "of all generators"});
  visit("label", c.label, {.help = "free text"});
  visit("retrieve", c.retrieve, {.help = "Places that look alike"});
}

Settings read(const std::string& yaml) {
  Settings settings;
  read_config(settings, yaml, "configs/mine.yaml");
  return settings;
}

std::string error_of(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

Settings assign(const std::string& assignment) {
  Settings settings;
  set_config(settings, assignment);
  return settings;
}

std::string set_error_of(const std::string& assignment) {
  try {
    assign(assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

TEST(Config, FieldsThatAreNamedChangeAndTheOthersKeepTheirValues) {
  const Settings settings = read(
      "retrieve:\n"
      "  search: sampled\n"
      "  sampling: {num_draws: 70}\n"
      "seed: -5\n");
  EXPECT_EQ(settings.seed, -5);
  EXPECT_EQ(settings.label, "office");
  EXPECT_EQ(settings.retrieve.search, Search::kSampled);
  EXPECT_EQ(settings.retrieve.sampling.num_draws, 70);
  EXPECT_TRUE(settings.retrieve.sampling.with_pause);
  EXPECT_EQ(settings.retrieve.min_similarity, 0.6);
}

TEST(Config, NothingChangesNothing) {
  const std::string unchanged = config_as_yaml(Settings{});
  for (const char* yaml : {"", "\n", "# only a comment\n", "{}", "~", "---\n", "retrieve:\n",
                           "retrieve: {}\n", "retrieve: {sampling: }\n"})
    EXPECT_EQ(config_as_yaml(read(yaml)), unchanged) << yaml;
}

TEST(Config, WhatIsWrittenIsReadBackExactly) {
  for (int seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Settings settings;
    settings.seed = static_cast<int>(random.index(1'000'000)) - 500'000;
    settings.label = "a: \"b\" #" + std::string(1, static_cast<char>(random.index(126) + 1)) + "\n";
    settings.retrieve.min_similarity = random.uniform(-1.0, 1.0);
    settings.retrieve.search = random.index(2) == 0 ? Search::kExact : Search::kSampled;
    settings.retrieve.sampling = {static_cast<int>(random.index(99)) + 1, random.index(2) == 0};
    for (const bool with_help : {false, true}) {
      const Settings back = read(config_as_yaml(settings, with_help));
      EXPECT_EQ(back.seed, settings.seed);
      EXPECT_EQ(back.label, settings.label);
      EXPECT_EQ(back.retrieve.min_similarity, settings.retrieve.min_similarity);
      EXPECT_EQ(back.retrieve.search, settings.retrieve.search);
      EXPECT_EQ(back.retrieve.sampling.num_draws, settings.retrieve.sampling.num_draws);
      EXPECT_EQ(back.retrieve.sampling.with_pause, settings.retrieve.sampling.with_pause);
    }
  }
}

TEST(Config, DoublesNeverLookLikeWholeNumbers) {
  Settings settings;
  settings.retrieve.min_similarity = 1.0;
  EXPECT_THAT(config_as_yaml(settings), HasSubstr("min_similarity: 1.0\n"));
}

TEST(Config, AValueOutsideItsRangeIsToldWithRangeFileAndLine) {
  std::string yaml(10, '\n');
  yaml += "retrieve:\n  min_similarity: 7\n";
  EXPECT_EQ(error_of(yaml),
            "retrieve.min_similarity = 7 is outside [-1, 1]  (configs/mine.yaml, line 12)");
  EXPECT_EQ(error_of("retrieve: {sampling: {num_draws: 0}}"),
            "retrieve.sampling.num_draws = 0 is outside >= 1  (configs/mine.yaml, line 1)");
}

TEST(Config, AnErrorLeavesTheConfigurationAsItWas) {
  Settings settings;
  EXPECT_THROW(read_config(settings, "seed: 9\nlabel: [1]\n", "x.yaml"), InputError);
  EXPECT_EQ(settings.seed, 1);
}

TEST(Config, AnUnknownKeyIsNamedWithItsLineAndWhatWasExpected) {
  EXPECT_EQ(error_of("seed: 2\nretrieve:\n  min_similarty: 0.5\n"),
            "unknown key retrieve.min_similarty  (configs/mine.yaml, line 3); expected one of: "
            "min_similarity, search, sampling");
  EXPECT_THAT(error_of("sede: 2"), HasSubstr("unknown key sede  (configs/mine.yaml, line 1)"));
}

TEST(Config, AKeyGivenTwiceIsAnError) {
  EXPECT_EQ(error_of("seed: 2\nlabel: a\nseed: 3\n"),
            "seed is given twice  (configs/mine.yaml, line 3)");
  EXPECT_THAT(error_of("retrieve:\n  search: exact\n  search: sampled\n"),
              HasSubstr("retrieve.search is given twice  (configs/mine.yaml, line 3)"));
  EXPECT_THAT(error_of("retrieve:\nseed: 1\nretrieve: {search: exact}\n"),
              HasSubstr("retrieve is given twice  (configs/mine.yaml, line 3)"));
}

TEST(Config, ANumberMustBeAWholeFiniteNumberOfItsType) {
  EXPECT_THAT(error_of("seed: many"), HasSubstr("seed = many is not a whole number"));
  EXPECT_THAT(error_of("seed: 1.5"), HasSubstr("seed = 1.5 is not a whole number"));
  EXPECT_THAT(error_of("seed: 12x"), HasSubstr("seed = 12x is not a whole number"));
  EXPECT_THAT(error_of("seed: ''"), HasSubstr("seed =  is not a whole number"));
  EXPECT_THAT(error_of("seed: 3000000000"), HasSubstr("does not fit into a whole number"));
  for (const char* text : {"nan", ".nan", "inf", "-.inf", "half", "0x1", "1,5"})
    EXPECT_THAT(error_of(std::string("retrieve: {min_similarity: '") + text + "'}"),
                HasSubstr(std::string("retrieve.min_similarity = ") + text + " is not a number"));
}

TEST(Config, ASwitchIsTrueOrFalseAndAChoiceIsOneOfItsNames) {
  EXPECT_THAT(error_of("retrieve: {sampling: {with_pause: yes}}"),
              HasSubstr("retrieve.sampling.with_pause = yes is not one of true, false"));
  EXPECT_THAT(error_of("retrieve: {search: fast}"),
              HasSubstr("retrieve.search = fast is not one of exact, sampled"));
}

TEST(Config, AValueWhereASectionBelongsAndTheOtherWayRound) {
  EXPECT_EQ(error_of("seed: 1\nretrieve: 5\n"),
            "retrieve must be a section with keys  (configs/mine.yaml, line 2)");
  EXPECT_THAT(error_of("retrieve: [1, 2]\n"), HasSubstr("retrieve must be a section"));
  EXPECT_THAT(error_of("label: {a: 1}\n"), HasSubstr("label must be a single value"));
  EXPECT_THAT(error_of("seed: [1]\n"), HasSubstr("seed must be a single value"));
  EXPECT_THAT(error_of("seed:\n"), HasSubstr("seed must be a single value"));
  EXPECT_THAT(error_of("just text"), HasSubstr("the configuration must be a section"));
  EXPECT_THAT(error_of("- a\n- b\n"), HasSubstr("the configuration must be a section"));
}

TEST(Config, TextThatIsNoYamlIsToldWithItsLine) {
  EXPECT_THAT(error_of("seed: 1\nretrieve: {search: exact\n"),
              AllOf(HasSubstr("configs/mine.yaml, line"), HasSubstr("not YAML")));
  EXPECT_THAT(error_of("seed: 1\n\tlabel: x\n"), HasSubstr("configs/mine.yaml"));
  EXPECT_THAT(error_of("seed: *nowhere\n"), HasSubstr("not YAML"));
  EXPECT_THAT(error_of("? [a, b]\n: 1\n"), HasSubstr("unknown key"));
  EXPECT_THAT(error_of(std::string("seed: \xff\xfe\x01", 9)), Not(HasSubstr("(no InputError)")));
}

TEST(Config, ASecondDocumentIsNotSilentlyDropped) {
  EXPECT_THAT(error_of("seed: 1\n---\nseed: 2\n"), HasSubstr("several YAML documents"));
}

TEST(Config, OneFieldIsSetByItsDottedName) {
  EXPECT_EQ(assign("seed=9").seed, 9);
  EXPECT_EQ(assign("retrieve.min_similarity=-0.25").retrieve.min_similarity, -0.25);
  EXPECT_EQ(assign("retrieve.sampling.num_draws=10").retrieve.sampling.num_draws, 10);
  EXPECT_EQ(assign("retrieve.sampling.num_draws=10").retrieve.search, Search::kExact);
  EXPECT_EQ(assign("label=a=b: {c} # d").label, "a=b: {c} # d") << "the value is taken as it is";
  EXPECT_EQ(assign("label=").label, "");
}

TEST(Config, ABadAssignmentIsToldAsItWasTyped) {
  EXPECT_EQ(set_error_of("retrieve.min_similarity=7"),
            "retrieve.min_similarity = 7 is outside [-1, 1]  (--set retrieve.min_similarity=7)");
  EXPECT_THAT(set_error_of("retrieve.nope=1"), HasSubstr("unknown key retrieve.nope"));
  EXPECT_THAT(set_error_of("retrieve=1"), HasSubstr("retrieve must be a section with keys"));
  EXPECT_THAT(set_error_of("seed.deeper=1"), HasSubstr("seed must be a single value"));
  EXPECT_THAT(set_error_of("seed"), HasSubstr("expected section.key=value"));
  EXPECT_THAT(set_error_of("=1"), HasSubstr("expected section.key=value"));
  EXPECT_THAT(set_error_of(".seed=1"), HasSubstr("expected section.key=value"));
  EXPECT_THAT(set_error_of("retrieve..search=exact"), HasSubstr("unknown key retrieve."));
  EXPECT_THAT(set_error_of("retrieve.search.=exact"), Not(HasSubstr("(no InputError)")));
  EXPECT_THAT(set_error_of(""), HasSubstr("expected section.key=value"));
}

TEST(Config, AnOptionOfItsOwnIsNamedAsTheOrigin) {
  Settings settings;
  try {
    set_config(settings, "seed=nine", "--seed nine");
    FAIL() << "nine is no number";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "seed = nine is not a whole number  (--seed nine)");
  }
}

TEST(Config, TheTableAndTheHelpNameEveryKeyRangeAndMeaning) {
  const std::string table = config_as_table(Settings{});
  EXPECT_THAT(table, HasSubstr("| `retrieve.min_similarity` | `0.6` | [-1, 1] | cosine |"));
  EXPECT_THAT(table, HasSubstr("## retrieve.sampling\n\nSampled search.\n"));
  const std::string yaml = config_as_yaml(Settings{}, true);
  EXPECT_THAT(yaml, HasSubstr("  # cosine; [-1, 1]\n"));
  EXPECT_THAT(yaml, HasSubstr("search: exact"));
}

struct Method {
  double damping = 0.5;
};

struct Solver {
  int iterations = 10;
  double tolerance = 1e-3;
  Method method;
  Sampling unused;
};

void visit_fields(Method& c, FieldVisitor& visit) {
  visit("damping", c.damping, {.help = "of a step"});
}

void visit_fields(Solver& c, FieldVisitor& visit) {
  visit.renamed("steps", "iterations");
  visit.renamed("method.gain", "method.damping");
  visit.renamed("verbose", "");
  visit("iterations", c.iterations, {.help = "at most"});
  visit("tolerance", c.tolerance, {.help = "of the cost", .is_expert = true});
  visit("method", c.method, {.help = "Method", .is_expert = true});
  visit("unused", c.unused, {.help = "Not in this run", .is_used = false});
}

std::string solver_error_of(const std::string& yaml) {
  try {
    Solver solver;
    read_config(solver, yaml, "mine.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

TEST(Config, AKeyOfAnEarlierVersionIsRefusedWithItsNameNow) {
  EXPECT_EQ(solver_error_of("steps: 3"), "steps is now iterations  (mine.yaml, line 1)");
  EXPECT_EQ(solver_error_of("iterations: 2\nmethod:\n  gain: 1"),
            "method.gain is now method.damping  (mine.yaml, line 3)");
  EXPECT_EQ(solver_error_of("verbose: 3"), "verbose is no setting any more  (mine.yaml, line 1)");
  EXPECT_THAT(solver_error_of("gain: 3"), HasSubstr("unknown key gain"));
}

TEST(Config, ExpertSettingsAreListedApart) {
  EXPECT_EQ(config_as_yaml(Solver{}, false, Listed::kBasic), "iterations: 10\n");
  EXPECT_EQ(config_as_yaml(Solver{}, false, Listed::kExpert),
            "tolerance: 0.001\nmethod:\n  damping: 0.5\n");
  EXPECT_EQ(config_as_yaml(Solver{}),
            "iterations: 10\ntolerance: 0.001\nmethod:\n  damping: 0.5\n");
  EXPECT_THAT(config_as_table(Solver{}, Listed::kBasic), Not(HasSubstr("## method")));
  EXPECT_THAT(config_as_table(Solver{}, Listed::kExpert), HasSubstr("## method"));
}

TEST(Config, ASectionWithoutUseIsReadButNotWritten) {
  EXPECT_EQ(solver_error_of("unused:\n  num_draws: 3"), "(no InputError)");
  EXPECT_THAT(config_as_yaml(Solver{}), Not(HasSubstr("unused")));
}

}  // namespace
}  // namespace samewhere::core
