#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "calib/store/yaml_reader.h"
#include "calib/store/yaml_text.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

using calib::YamlReader;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The syntax problems of a text.
std::vector<std::string> syntaxProblems(const std::string& text) {
  return problemsOf([&] {
    const YamlReader reader(text, "f");
    reader.throwIfProblems();
    return 0;
  });
}

std::string repeated(const std::string& piece, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += piece;
  return text;
}

TEST(StoreYaml, PlacesProblemsByLineAndColumn) {
  const YamlReader reader("a: [1, x]\nb:\n  c: 3\n", "f.yaml");
  EXPECT_THAT(reader.root().required("a").numbers(2), ElementsAre(1, 0));
  EXPECT_EQ(reader.root().required("b").required("c").integer(0, 2), 0);
  ASSERT_EQ(reader.problems().size(), 2U);
  EXPECT_EQ(reader.problems()[0].text(), "f.yaml:1:8: a: expected a number, found \"x\"");
  EXPECT_EQ(reader.problems()[1].text(), "f.yaml:3:6: c: expected a whole number from 0 to 2, found \"3\"");
}

TEST(StoreYaml, ReadsTheKindsOfValues) {
  const YamlReader reader("n: +1.5\ni: -7\nt: true\ns: \"a: b\\n\"\nl: [1, 2]\nm: {k: v, o: w}\n", "f");
  const auto root = reader.root();
  EXPECT_EQ(root.required("n").number(1, 2), 1.5);
  EXPECT_EQ(root.required("i").integer(-7, 7), -7);
  EXPECT_TRUE(root.required("t").boolean());
  EXPECT_EQ(root.required("s").text(), "a: b\n");
  EXPECT_THAT(root.required("l").numbers(2), ElementsAre(1, 2));
  EXPECT_THAT(root.required("m").keys(), ElementsAre("k", "o"));
  EXPECT_FALSE(root.optional("x").defined());
  EXPECT_EQ(root.optional("x").optional("y").text(), "");
  root.refuseUnknownKeys();
  root.required("m").refuseUnknownKeys();
  EXPECT_THAT(reader.problems(), IsEmpty());
}

TEST(StoreYaml, RefusesWhatIsNotANumber) {
  for (const std::string text :
       {"", "~", "nan", ".nan", "inf", "-inf", ".inf", "1e999", "0x10", "1 2", "1,5", "+-1", "[]"}) {
    const YamlReader reader("v: " + text, "f");
    EXPECT_EQ(reader.root().required("v").number(-1e300, 1e300), 0) << text;
    EXPECT_EQ(reader.problems().size(), 1U) << text;
  }
}

TEST(StoreYaml, RefusesWhatIsNotAWholeNumber) {
  for (const std::string text : {"1.5", "1e3", "99999999999999999999", "a", "[1]", "2147483648"}) {
    const YamlReader reader("v: " + text, "f");
    EXPECT_EQ(reader.root().required("v").integer(5, 2147483647), 5) << text;
    EXPECT_EQ(reader.problems().size(), 1U) << text;
  }
}

TEST(StoreYaml, SuggestsTheNearestKnownKey) {
  const YamlReader reader("fiducal: 1\nzzz: 2\n", "f");
  (void)reader.root().optional("fiducials");
  (void)reader.root().optional("camera");
  reader.root().refuseUnknownKeys();
  ASSERT_EQ(reader.problems().size(), 2U);
  EXPECT_EQ(reader.problems()[0].message, "unknown key \"fiducal\"; did you mean \"fiducials\"?");
  EXPECT_EQ(reader.problems()[1].message, "unknown key \"zzz\"");
}

TEST(StoreYaml, AsksOnceForAMapThatIsNotThere) {
  const YamlReader reader("a: 3\n", "f");
  (void)reader.root().required("a").required("b");
  (void)reader.root().required("a").required("c");
  EXPECT_EQ(reader.problems().size(), 1U);
}

TEST(StoreYaml, MovesMembersForMigration) {
  YamlReader reader("old: 5\nkeep: 1\n", "f");
  reader.moveMember("old", "new.deep.name");
  reader.moveMember("absent", "new.other");
  EXPECT_EQ(reader.root().required("new").required("deep").required("name").integer(0, 9), 5);
  EXPECT_FALSE(reader.root().optional("old").defined());
  (void)reader.root().required("new").required("deep").required("name").integer(0, 4);
  ASSERT_EQ(reader.problems().size(), 1U);
  EXPECT_EQ(reader.problems()[0].line, 1);
}

TEST(StoreYaml, SyntaxProblemsNameTheirPlace) {
  EXPECT_THAT(syntaxProblems(""), ElementsAre("0:0 the file is empty"));
  EXPECT_THAT(syntaxProblems("# only a remark\n"), ElementsAre("0:0 the file is empty"));
  EXPECT_THAT(syntaxProblems("a: 1\n\tb: 2\n"), ElementsAre("2:1 a tab in the indentation: YAML wants spaces"));
  EXPECT_THAT(syntaxProblems("a: 1\nb: \xff\n"), ElementsAre("2:4 not valid UTF-8"));
  EXPECT_THAT(syntaxProblems("a: \xc3"), ElementsAre("1:4 not valid UTF-8"));
  EXPECT_THAT(syntaxProblems("a: \xc0\xaf"), ElementsAre("1:4 not valid UTF-8"));
  EXPECT_THAT(syntaxProblems("a: \xed\xa0\x80"), ElementsAre("1:4 not valid UTF-8"));
  EXPECT_THAT(syntaxProblems(std::string("ab: 1\0", 6)), ElementsAre("1:6 a NUL byte: this is not a text file"));
  EXPECT_THAT(syntaxProblems("a: \x04 b"), ElementsAre("1:4 a control character: this is not a text file"));
  EXPECT_THAT(syntaxProblems("a: 1\nb: [1, 2\nc: 3\n"), ElementsAre(HasSubstr("not valid YAML: ")));
  EXPECT_THAT(syntaxProblems("a: b: c\n"), ElementsAre(HasSubstr("1:5 not valid YAML: ")));
  EXPECT_THAT(syntaxProblems("a: 1\na: 2\n"), ElementsAre("2:1 the key \"a\" is given twice"));
  EXPECT_THAT(syntaxProblems("? [a]\n: 1\n"), ElementsAre(HasSubstr("a key must be plain text")));
  EXPECT_THAT(syntaxProblems("a: 1\n---\nb: 2\n"), ElementsAre(HasSubstr("a second document")));
  EXPECT_THAT(syntaxProblems("a: &x 1\nb: *x\n"), ElementsAre(HasSubstr("anchors are not supported")));
  EXPECT_THAT(syntaxProblems("b: *x\n"), ElementsAre(HasSubstr("1:4 ")));
  EXPECT_THAT(syntaxProblems("b: !!binary x\n"), ElementsAre(HasSubstr("tags are not supported")));
}

TEST(StoreYaml, AcceptsAByteOrderMarkAndWindowsLines) {
  const YamlReader reader(
      "\xef\xbb\xbf"
      "a: \xc3\xbc\r\nb: 2\r\n",
      "f");
  EXPECT_EQ(reader.root().required("a").text(), "\xc3\xbc");
  EXPECT_EQ(reader.root().required("b").integer(0, 9), 2);
  EXPECT_THAT(reader.problems(), IsEmpty());
}

TEST(StoreYaml, DeepNestingIsRefusedWithoutOverflowingTheStack) {
  for (const std::string piece : {"[", "{a: ", "- ", "? ", "a:\n", "[[", "{? ", "{[", "!!x ", "& "}) {
    EXPECT_THAT(syntaxProblems(repeated(piece, 200'000)), ::testing::Not(IsEmpty())) << piece;
  }
  std::string indented;
  for (std::size_t depth = 0; depth < 3000; ++depth) indented += std::string(depth, ' ') + "a:\n";
  EXPECT_THAT(syntaxProblems(indented), Contains(HasSubstr("nested too deeply")));
}

TEST(StoreYaml, ExpandingAliasesAreRefused) {
  std::string text = "a: &a [x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c <= 'i'; ++c) {
    const std::string alias = std::string("*") + static_cast<char>(c - 1);
    text += std::string(1, c) + ": &" + c + " [" + repeated(alias + ", ", 8) + alias + "]\n";
  }
  EXPECT_THAT(syntaxProblems(text), ElementsAre(HasSubstr("anchors are not supported")));
}

TEST(StoreYaml, TextBeyondTheBoundIsRefusedUnread) {
  EXPECT_THAT(syntaxProblems(std::string((std::size_t{64} << 20) + 1, 'a')), ElementsAre("0:0 larger than 64 MiB"));
  EXPECT_THAT(syntaxProblems("[" + repeated("1,", 9'000'000) + "1]"),
              ElementsAre("0:0 has more parts than any wall could need"));
}

TEST(StoreYaml, ManyProblemsAreCutOff) {
  const YamlReader reader(repeated("a: 1\n", 100'000), "f");
  ASSERT_EQ(reader.problems().size(), 201U);
  EXPECT_EQ(reader.problems().back().message, "and more problems, not listed");
}

TEST(StoreYaml, LongTextsAreShortenedInMessages) {
  const YamlReader reader("a: " + repeated("\xc3\xbc", 500), "f");
  (void)reader.root().required("a").number(0, 1);
  ASSERT_EQ(reader.problems().size(), 1U);
  EXPECT_LT(reader.problems()[0].message.size(), 120U);
  EXPECT_THAT(reader.problems()[0].message, HasSubstr("\xc3\xbc\xc3\xbc…\""));
}

TEST(StoreYaml, QuotesTextsThatYamlWouldReadDifferently) {
  EXPECT_EQ(calib::yamlText("HDMI-1"), "HDMI-1");
  EXPECT_EQ(calib::yamlText("readings/p1.csv"), "readings/p1.csv");
  for (const std::string text :
       {"",   " ",    "a b",  "null", "~", "true", "- a", "a: b", "a #b", "\"", "\\",  "'x'", "{",   "\n",
        "\t", "\x01", "\x7f", "é",    "@", "%",    "a,b", "*x",   "&x",   "?",  "---", "...", "NULL"}) {
    const YamlReader reader("m: {k: " + calib::yamlText(text) + "}\n" + calib::yamlText(text) + ": 1\n", "f");
    EXPECT_EQ(reader.root().required("m").required("k").text(), text);
    EXPECT_THAT(reader.root().keys(), ElementsAre("m", text));
    EXPECT_THAT(reader.problems(), IsEmpty()) << text;
  }
}

TEST(StoreYaml, WritesNumbersShortestAndExact) {
  EXPECT_EQ(calib::yamlNumber(0.1), "0.1");
  EXPECT_EQ(calib::yamlNumber(24), "24");
  EXPECT_EQ(calib::yamlNumber(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(calib::yamlList({1, 2.5}), "[1, 2.5]");
  EXPECT_EQ(calib::yamlList(std::vector<double>{}), "[]");
}

}  // namespace
}  // namespace pixelflex::testing
