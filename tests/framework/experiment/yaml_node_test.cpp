#include "framework/experiment/yaml/yaml_node.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

std::string getYamlError(const std::string& text) {
  try {
    parseYaml(text, "f.yaml");
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(YamlNode, KeepsOrderAndPlaces) {
  const YamlNode root = parseYaml("b: 1\na:\n  - x: [2, '3']\n", "f.yaml");
  ASSERT_EQ(root.entries.size(), 2u);
  EXPECT_EQ(root.entries[0].key, "b");
  const YamlNode& list = root.find("a")->items.at(0).find("x")->items.at(1);
  EXPECT_EQ(list.scalar, "3");
  EXPECT_TRUE(list.quoted);
  EXPECT_EQ(list.where.line, 3);
  EXPECT_EQ(list.where.column, 12);
  EXPECT_EQ(list.where.key_path, "a[0].x[1]");
}

TEST(YamlNode, ExpandsAliases) {
  const YamlNode root = parseYaml("a: &k {v: 1}\nb: *k\n", "f.yaml");
  EXPECT_EQ(root.find("b")->find("v")->scalar, "1");
  EXPECT_EQ(root.find("b")->find("v")->where.key_path, "b.v");
}

TEST(YamlNode, RefusesWhatWouldBeMisread) {
  EXPECT_EQ(getYamlError("a: 1\nb: 2\na: 3\n"), "f.yaml:3:1: 'a' is given twice in the same map");
  EXPECT_NE(getYamlError("a: &k {v: 1}\nb: {<<: *k}\n").find("merge key"), std::string::npos);
  EXPECT_NE(getYamlError("a: !!int 3\n").find("is a tag"), std::string::npos);
  EXPECT_NE(getYamlError("a: 1\n---\nb: 2\n").find("second document"), std::string::npos);
  EXPECT_NE(getYamlError("[1, 2]: 3\n").find("cannot be a key"), std::string::npos);
  EXPECT_NE(getYamlError(std::string("a: \0b", 5)).find("binary"), std::string::npos);
  EXPECT_EQ(getYamlError("a: [1, 2\n").rfind("f.yaml:2:", 0), 0u);
}

TEST(YamlNode, SaysWhereALineIsToBegin) {
  const auto says = [](const std::string& lines, const std::string& words) {
    EXPECT_NE(getYamlError("name: cart\nsystem:\n" + lines).find(words), std::string::npos)
        << getYamlError("name: cart\nsystem:\n" + lines);
  };
  says(
      "    bodies:\n      - {name: b}\n  springs: []\n",
      "f.yaml:5:3: is not valid YAML: the line begins at column 3, between two levels: indent it like line 3 "
      "(column 5) or like line 2 (column 1)");
  says("  bodies:\n    - name: b\n     mass: 1\n",
       "begins at column 6, between two levels: indent it like line 4 (column 7) or like line 4 (column 5)");
  says("  bodies:\n    # of steel\n    - {name: b}\n     - {name: c}\n",
       "further right than the one before it, which has its value already: indent it like line 5 (column 5)");
  says("  bodies:\n    - {name: b}\n  - {name: c}\n",
       "the item stands beside the keys of line 3 (column 3): indent it like line 4 (column 5)");
  says("  bodies:\n    - name: b\n       mass: 1\n",
       "further right than the one before it, which has its value already: indent it like line 4 (column 7)");
}

TEST(YamlNode, AsksForQuotesWhereABracketOrAColonCutsAText) {
  for (const char* text : {"a: {force: F > 0 ? 1 : 2}\n", "a: {column: F [N]}\n", "a: [x, F [N]]\n"}) {
    EXPECT_NE(getYamlError(text).find("needs quotes"), std::string::npos) << text << getYamlError(text);
  }
}

TEST(YamlNode, AsksForQuotesWhereACommaCutsATerm) {
  EXPECT_EQ(
      getYamlError("a: {coordinate: x, force: max(F, 0)}\n"),
      "f.yaml:1:27: 'max(F' ends at a comma: in braces and brackets a text that holds one needs quotes, "
      "\"max(F, 0)\"");
  EXPECT_NE(getYamlError("a: [1, min(u, -v), 2]\n").find("\"min(u, -v)\""), std::string::npos);
  EXPECT_NE(getYamlError("a: {x: max(a, min(b, c)), y: 2}\n").find("\"max(a, min(b\""), std::string::npos);
  for (const char* text : {"a: {x: 'max(a, b)', y: 2}\n", "a:\n  x: max(a, b)\n  y: (\n  z: 1\n",
                           "a: {x: f(a), y: \"(\", z: 1}\n", "a: [f(a), (b)]\n"}) {
    EXPECT_EQ(getYamlError(text), "") << text;
  }
}

TEST(YamlNode, ListsAmongKeysAndRoundBracketsAreNamed) {
  EXPECT_NE(getYamlError("a:\n  b: 1\n  - c: 2\n  d: 3\n").find("an item of a list stands among the keys"),
            std::string::npos)
      << getYamlError("a:\n  b: 1\n  - c: 2\n  d: 3\n");
  EXPECT_NE(getYamlError("a:\n  - {c: 2}\n  d: 3\n").find("a key stands among the items"), std::string::npos)
      << getYamlError("a:\n  - {c: 2}\n  d: 3\n");
  EXPECT_EQ(getYamlError("a: {bounds: (80, 120), unit: N}\n"),
            "f.yaml:1:13: '(80, 120)' is not a list: write [80, 120]");
  EXPECT_NE(getYamlError("a: {at: (x, y)}\n").find("write [x, y]"), std::string::npos);
  EXPECT_EQ(getYamlError("a:\n- 1\nb: 2\n"), "");  // a list may stand beside its key
}

TEST(YamlNode, AnEmptyFileHasAPlaceToo) {
  EXPECT_EQ(parseYaml("", "f.yaml").where.file, "f.yaml");
  EXPECT_EQ(getYamlError(std::string("a: 1\nb: \0", 9)).rfind("f.yaml:2:1: has a NUL byte", 0), 0u);
}

TEST(YamlNode, RefusesDeepNestingAndAliasBombs) {
  EXPECT_NE(getYamlError(std::string(100000, '[')), "");
  EXPECT_NE(getYamlError("a: &a [*a]\n"), "");
  std::string bomb = "x0: &x0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string last = "*x" + std::to_string(i - 1);
    bomb += "x" + std::to_string(i) + ": &x" + std::to_string(i) + " [";
    for (int k = 0; k < 9; ++k) {
      bomb += last + ", ";
    }
    bomb += last + "]\n";
  }
  EXPECT_NE(getYamlError(bomb).find("more than a million values"), std::string::npos);
}

TEST(YamlNode, RefusesWhatIsNotUtf8) {
  for (const char* text : {"a: \xff", "# \xe4", "# \xc0\x80", "# \xed\xa0\x80", "# \xe2\x82"}) {
    EXPECT_EQ(getYamlError(std::string("b: 1\n") + text)
                  .rfind("f.yaml:2:1: has a byte in this line that is not", 0),
              0u)
        << text;
  }
  EXPECT_EQ(parseYaml("\xef\xbb\xbf"
                      "a: \u00b5m\n",
                      "f.yaml")
                .find("a")
                ->scalar,
            "\u00b5m");
}

TEST(YamlNode, BoundsKeysAndLevelsSoThatKeyPathsStaySmall) {
  EXPECT_NE(getYamlError("? " + std::string(101, 'k') + "\n: 1\n").find("a key of more than 100"),
            std::string::npos);
  EXPECT_EQ(getYamlError(std::string(20, '[') + std::string(20, ']')), "");
  EXPECT_NE(getYamlError(std::string(21, '[') + std::string(21, ']')).find("more than 20 levels"),
            std::string::npos);
}

TEST(YamlNode, ReadsAMapOfManyKeysInLinearTime) {
  std::string text;
  for (int i = 0; i < 100000; ++i) {
    text += "k" + std::to_string(i) + ": 1\n";
  }
  EXPECT_EQ(parseYaml(text, "f.yaml").entries.size(), 100000u);
}

TEST(ExperimentError, ShowsTheBeginningOfAValueOnOneLine) {
  const std::string message =
      ExperimentError({"f", 1, 1, "k"}, "a\n\x1b" + std::string(500, 'x'), "is wrong").what();
  EXPECT_EQ(message, "f:1:1: k: 'a  " + std::string(77, 'x') + "...' is wrong");
  const std::string cut =
      ExperimentError({"f", 1, 1, ""}, std::string(79, 'x') + "\u00b5m", "is wrong").what();
  EXPECT_EQ(cut, "f:1:1: '" + std::string(79, 'x') + "...' is wrong");
}

TEST(YamlNode, WrittenYamlParsesToTheSameTree) {
  const std::string text = "a: 1\nb: [x, \"5\", '#no comment']\nc: {d: \"k: v\", e: [{f: 1}, {g: []}]}\n";
  const YamlNode root = parseYaml(text, "f.yaml");
  const std::string written = writeYaml(root);
  EXPECT_EQ(writeYaml(parseYaml(written, "f.yaml")), written);
  EXPECT_EQ(parseYaml(written, "f.yaml").find("c")->find("d")->scalar, "k: v");
  EXPECT_TRUE(parseYaml(written, "f.yaml").find("b")->items[1].quoted);
}

TEST(YamlNode, NamesTheFileThatCannotBeRead) {
  EXPECT_THROW(loadYaml("/no/such/file.yaml"), ExperimentError);
  EXPECT_THROW(loadYaml("/"), ExperimentError);
}

}  // namespace
}  // namespace twinmap
