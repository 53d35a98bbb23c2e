// What the program says when it is asked for help or called wrongly.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "app/process.h"

namespace nephroid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<std::string> kCommands{"render",     "compare", "bench",      "info",   "scenes",
                                         "techniques", "devices", "completion", "manual", "help"};

/// Exit code 2, nothing on stdout, one line "error: …" on stderr that holds `text`.
void expectUsageError(const std::vector<std::string>& arguments, const std::string& text) {
  const ProcessResult result = runNephroid(arguments);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, StartsWith("error: "));
  EXPECT_THAT(result.err, HasSubstr(text));
  EXPECT_EQ(countLines(result.err), 1) << result.err;
}

TEST(Help, GoesToStdoutAndNamesEveryCommand) {
  const ProcessResult result = runNephroid({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const std::string& command : kCommands) EXPECT_THAT(result.out, HasSubstr(fmt::format("\n  {}\n", command)));
}

TEST(Help, OfEachCommandHasUsageAndFitsTheTerminal) {
  for (const std::string& command : kCommands) {
    const ProcessResult result = runNephroid({command, "--help"});
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_THAT(result.out, HasSubstr("Usage: nephroid " + command)) << command;
    EXPECT_TRUE(runNephroid({"help", command}).out == result.out) << command;
    std::istringstream lines(result.out.substr(0, result.out.find("Metrics:")));
    for (std::string line; std::getline(lines, line) && line != "Examples:";) EXPECT_LE(line.size(), 80U) << line;
  }
}

TEST(Help, OfAnUnknownCommandIsWrongUsage) { expectUsageError({"help", "rendr"}, "no command 'rendr'"); }

TEST(Help, OfRenderTeachesByExampleDefaultRangeAndUnit) {
  const std::string text = runNephroid({"render", "--help"}).out;
  EXPECT_THAT(text, HasSubstr("nephroid render builtin:ring -o ring.png"));
  EXPECT_THAT(text, HasSubstr("[default: 1024x768; range: 1x1 to 16384x16384; unit:"));
  for (const char* option : {"--technique", "--size",         "--camera",    "--aov",     "--exposure",  "--tonemap",
                             "--photons",   "--samples",      "--seconds",   "--frames",  "--fps",       "--time",
                             "--env",       "--env-rotation", "--env-scale", "--light",   "--object",    "--material",
                             "--floor",     "--state",        "--device",    "--threads", "--seed",      "--set",
                             "--half",      "--stats",        "--verbose",   "--json",    "-o, --output"})
    EXPECT_THAT(text, HasSubstr(std::string("  ") + option)) << option;
}

TEST(Version, IsOneLine) {
  const ProcessResult result = runNephroid({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, ::testing::MatchesRegex("nephroid [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Usage, NoCommandIsAnErrorThatShowsTheFirstStep) {
  expectUsageError({}, "nephroid render builtin:ring -o ring.png");
}

TEST(Usage, SlipOfACommandIsUnderstood) { expectUsageError({"rendr"}, "did you mean 'render'?"); }

TEST(Usage, SlipOfAnOptionIsUnderstood) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--sample", "4"}, "did you mean '--samples'?");
}

TEST(Usage, SlipOfASceneIsUnderstood) { expectUsageError({"info", "builtin:rng"}, "ring"); }

TEST(Usage, UnknownTechniqueListsThoseThereAre) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--technique", "magic"}, "reference");
}

TEST(Usage, UnknownLayerListsThoseThereAre) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--aov", "caustics"}, "caustic");
}

TEST(Usage, UnknownParameterIsNamed) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--set", "nonsense=1"}, "nonsense");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--set", "nonsense"}, "KEY=VALUE");
}

TEST(Usage, ValueOutOfRangeNamesTheOption) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--size", "0x10"}, "--size");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--size", "99999x10"}, "16384");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--samples", "-3"}, "--samples");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--samples", "1.5"}, "--samples");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--seconds", "nan"}, "--seconds");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--exposure", "bright"}, "--exposure");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--tonemap", "acse"}, "--tonemap");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--frames", "5..1"}, "--frames");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--floor", "maybe"}, "--floor");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--threads", "many"}, "--threads");
}

TEST(Usage, OutputMustBeExrOrPng) {
  expectUsageError({"render", "builtin:ring", "-o", "a.jpg"}, "neither .exr nor .png");
  expectUsageError({"render", "builtin:ring"}, "-o picture.png");
}

TEST(Usage, RenderWithoutSceneSaysWhatASceneIs) { expectUsageError({"render", "-o", "a.png"}, "builtin:ring"); }

TEST(Usage, DeviceMustBeOneThatTheTechniqueTakes) {
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--device", "best"}, "expected auto, cpu or the number");
  expectUsageError({"render", "builtin:ring", "-o", "a.png", "--technique", "reference", "--device", "0"},
                   "reference computes on the CPU");
}

#ifdef NEPHROID_VULKAN  // the page lists the techniques of a whole build
TEST(Manual, PageIsTheOneThatTheProgramPrints) {
  EXPECT_EQ(runNephroid({"manual"}).out, readText(NEPHROID_SOURCE_DIR "/docs/nephroid.1"))
      << "options changed: nephroid manual > docs/nephroid.1";
}
#endif

TEST(Manual, HasEveryOptionOfEveryHelp) {
  const std::string page = readText(NEPHROID_SOURCE_DIR "/docs/nephroid.1");
  for (const std::string& command : kCommands) {
    const std::string help = runNephroid({command, "--help"}).out;
    for (std::size_t at = help.find("  --"); at != std::string::npos; at = help.find("  --", at + 1)) {
      std::string option;  // as roff writes it, with protected hyphens
      for (const char c : help.substr(at + 2, help.find_first_of(" \n", at + 2) - at - 2)) {
        if (c == '-') option += '\\';
        option += c;
      }
      EXPECT_THAT(page, HasSubstr(option)) << command;
    }
  }
}

TEST(Manual, IsWellFormedRoff) {
  const ProcessResult groff =
      runProcess({"groff", "-man", "-ww", "-Tutf8", "-z", NEPHROID_SOURCE_DIR "/docs/nephroid.1"});
  EXPECT_EQ(groff.exit_code, 0);
  EXPECT_EQ(groff.err, "");
}

/// What bash offers for `line` with the cursor at its end.
std::vector<std::string> complete(const std::string& line) {
  const std::string script =
      "set -e; script=$(" NEPHROID_PROGRAM
      " completion bash); eval \"$script\"; COMP_LINE=$1; COMP_POINT=${#1}; _nephroid; printf '%s\\n' "
      "\"${COMPREPLY[@]}\"";
  const ProcessResult result = runProcess({"bash", "-c", script, "bash", line});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  std::vector<std::string> words;
  std::istringstream stream(result.out);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

TEST(Completion, OffersCommandsOptionsChoicesAndScenes) {
  EXPECT_THAT(complete("nephroid ren"), ::testing::ElementsAre("render"));
  EXPECT_THAT(complete("nephroid dev"), ::testing::ElementsAre("devices"));
  EXPECT_THAT(complete("nephroid devices --j"), ::testing::ElementsAre("--json"));
  EXPECT_THAT(complete("nephroid render --tech"), ::testing::ElementsAre("--technique"));
  EXPECT_THAT(complete("nephroid render --technique "), ::testing::Contains("reference"));
  EXPECT_THAT(complete("nephroid render --tonemap f"), ::testing::ElementsAre("filmic"));
  EXPECT_THAT(complete("nephroid render --aov beauty,caus"),
              ::testing::ElementsAre("beauty,caustic", "beauty,caustic_error", "beauty,caustic_bias"));
  EXPECT_THAT(complete("nephroid scenes co"), ::testing::ElementsAre("cognac", "coffee"));
}

TEST(Completion, ContinuesAfterTheColonWhereBashSplitsWords) {
  EXPECT_THAT(complete("nephroid render builtin:pri"), ::testing::ElementsAre("prism"));
  EXPECT_THAT(complete("nephroid info builtin:"), ::testing::Contains("ring"));
  EXPECT_THAT(complete("nephroid info builtin:ring?lig"), ::testing::Contains("ring?light="));
}

TEST(Lists, OfScenesAndTechniquesAreValidForPeopleAndPrograms) {
  for (const char* command : {"scenes", "techniques"}) {
    const ProcessResult text = runNephroid({command});
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_THAT(text.out, HasSubstr("[default: "));
    const ProcessResult json = runNephroid({command, "--json"});
    EXPECT_EQ(json.exit_code, 0);
    EXPECT_THAT(json.out, StartsWith("["));
    EXPECT_EQ(json.err, "");
  }
  EXPECT_THAT(runNephroid({"scenes", "prism"}).out, Not(HasSubstr("builtin:ring")));
  expectUsageError({"scenes", "prsm"}, "did you mean 'prism'?");
  expectUsageError({"techniques", "refrence"}, "reference");
}

}  // namespace
}  // namespace nephroid::test
