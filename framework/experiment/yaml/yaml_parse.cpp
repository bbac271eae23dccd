#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <unordered_set>

#include "framework/experiment/yaml/yaml_layout.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {
namespace {

constexpr std::size_t kMaxFileValues = 1'000'000;
constexpr std::size_t kMaxLevels = 20;
constexpr std::size_t kLongestKey = 100;
constexpr std::size_t kLargestFile = 16 << 20;

SourceLocation locate(const std::string& file, const YAML::Mark& mark) {
  return {file, mark.line + 1, mark.column + 1, ""};
}

/// Whether a line (from 0) is indented by tabs, of which yaml-cpp says something else.
bool isIndentedByTab(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string found;
  for (int i = 0; i <= line; ++i) {
    std::getline(lines, found);
  }
  return found.substr(0, found.find_first_not_of(" \t")).find('\t') != std::string::npos;
}

/// What yaml-cpp says, in the file's own signs where it names brackets, or what it says of indentation.
std::string describe(const YAML::Exception& error, const std::string& text) {
  const std::string& problem = error.msg;
  if (isIndentedByTab(text, error.mark.line)) {
    return "the line is indented by a tab, where YAML takes spaces";
  }
  const std::string quotes = " here; a text that holds a bracket, ': ' or a comma needs quotes";
  if (problem == "end of sequence flow not found") {
    return "a list that begins with '[' is not closed by ']'" + quotes;
  }
  if (problem == "end of map flow not found") {
    return "a map that begins with '{' is not closed by '}'" + quotes;
  }
  const std::string layout = describeLayout(text, error.mark.line);
  return layout.empty() ? problem : layout;
}

/// Throws where the comma between the last value of a list or map in brackets and what comes next is one
/// of the value's own parentheses, as of max(F, 0).
void requireUncut(const YamlNode& parent, const YamlNode& next) {
  const bool is_list = parent.kind == YamlNode::Kind::kSequence;
  if (is_list ? parent.items.empty() : parent.entries.empty()) {
    return;
  }
  const YamlNode& last = is_list ? parent.items.back() : parent.entries.back().value;
  const std::string& text = last.scalar;
  if (!last.quoted && std::count(text.begin(), text.end(), '(') > std::count(text.begin(), text.end(), ')')) {
    const std::string behind = next.scalar.empty() ? "..." : next.scalar;
    if (text.front() == '(' && behind.back() == ')') {
      throw ExperimentError(
          last.where, text + ", " + behind,
          "is not a list: write [" + text.substr(1) + ", " + behind.substr(0, behind.size() - 1) + "]");
    }
    throw ExperimentError(last.where, text,
                          "ends at a comma: in braces and brackets a text that holds one needs quotes, \"" +
                              text + ", " + behind + "\"");
  }
}

/// Builds the tree from yaml-cpp's events. Containers under construction are on a stack; a map also holds
/// the key whose value comes next.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}

  YamlNode takeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node;
    node.where = locate(file_, mark);
    add(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      throw ExperimentError(locate(file_, mark), "*", "refers to a value that contains it");
    }
    countValues(found->second.size, mark);
    add(found->second.node, YAML::NullAnchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool quoted = tag == "!";
    if (!quoted && tag != "?" && !tag.empty()) {
      throw ExperimentError(locate(file_, mark), tag, "is a tag; twinmap reads plain YAML without tags");
    }
    YamlNode node = makeScalar(value, quoted);
    node.where = locate(file_, mark);
    countValues(1, mark);
    add(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(makeSequence(), mark, tag, anchor, style);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(makeMap(), mark, tag, anchor, style);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    bool in_brackets;  ///< where a comma ends a text
    std::size_t values_before;
    std::unordered_set<std::string> keys;
    bool has_key = false;
    std::string key;
    SourceLocation key_where;
  };
  struct Anchored {
    YamlNode node;
    std::size_t size;
  };

  void countValues(std::size_t count, const YAML::Mark& mark) {
    values_ += count;
    if (values_ > kMaxFileValues) {
      throw ExperimentError(locate(file_, mark), "", "the file holds more than a million values");
    }
  }

  void open(YamlNode node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            YAML::EmitterStyle::value style) {
    if (tag != "?" && !tag.empty()) {
      throw ExperimentError(locate(file_, mark), tag, "is a tag; twinmap reads plain YAML without tags");
    }
    node.where = locate(file_, mark);
    const std::size_t values_before = values_;
    countValues(1, mark);
    if (stack_.size() == kMaxLevels) {
      throw ExperimentError(locate(file_, mark), "", "is nested more than 20 levels deep");
    }
    const bool in_brackets = style == YAML::EmitterStyle::Flow;
    stack_.push_back({std::move(node), anchor, in_brackets, values_before, {}, false, "", {}});
  }

  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    add(std::move(done.node), done.anchor, values_ - done.values_before);
  }

  void add(YamlNode node, YAML::anchor_t anchor, std::size_t size = 1) {
    if (anchor != YAML::NullAnchor) {
      anchors_[anchor] = {node, size};
    }
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = stack_.back();
    if (parent.in_brackets && !parent.has_key) {
      requireUncut(parent.node, node);
    }
    if (parent.node.kind == YamlNode::Kind::kSequence) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.has_key) {
      takeKey(parent, node);
    } else {
      parent.node.entries.push_back({std::move(parent.key), std::move(parent.key_where), std::move(node)});
      parent.has_key = false;
    }
  }

  static void takeKey(Open& parent, const YamlNode& key) {
    if (key.kind != YamlNode::Kind::kScalar) {
      throw ExperimentError(key.where, describeValue(key), "cannot be a key; keys are plain names");
    }
    if (key.scalar == "<<" && !key.quoted) {
      throw ExperimentError(key.where, "<<", "is a merge key, which YAML 1.2 does not have; repeat the keys");
    }
    if (key.scalar.size() > kLongestKey) {
      throw ExperimentError(key.where, key.scalar, "is a key of more than 100 characters");
    }
    if (!parent.keys.insert(key.scalar).second) {
      throw ExperimentError(key.where, key.scalar, "is given twice in the same map");
    }
    parent.has_key = true;
    parent.key = key.scalar;
    parent.key_where = key.where;
  }

  std::string file_;
  YamlNode root_;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  std::size_t values_ = 0;
};

SourceLocation locateByte(const std::string& text, std::string::const_iterator byte,
                          const std::string& file) {
  return {file, static_cast<int>(std::count(text.begin(), byte, '\n')) + 1, 1, ""};
}

/// yaml-cpp would replace what is not UTF-8.
void requireText(const std::string& text, const std::string& file) {
  const auto nul = std::find(text.begin(), text.end(), '\0');
  if (nul != text.end()) {
    throw ExperimentError(locateByte(text, nul, file), "",
                          "has a NUL byte in this line: a binary file or UTF-16, not YAML in UTF-8");
  }
  using Utf8 = boost::locale::utf::utf_traits<char>;
  for (auto character = text.begin(); character != text.end();) {
    const auto begin = character;
    const boost::locale::utf::code_point code = Utf8::decode(character, text.end());
    if (code == boost::locale::utf::illegal || code == boost::locale::utf::incomplete) {
      throw ExperimentError(locateByte(text, begin, file), "",
                            "has a byte in this line that is not UTF-8; save the file as UTF-8");
    }
  }
}

/// The whole stream, or at least its first `most` bytes.
std::string readStart(std::istream& stream, std::size_t most) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  std::string text;
  while (stream && text.size() < most) {
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    stream.read(text.data() + before, static_cast<std::streamsize>(kBlock));
    text.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  return text;
}

/// What a file that is not YAML is, by its first bytes, and what to do; empty if they do not tell.
std::string describeOtherFormat(const std::string& text) {
  const auto begins = [&text](const std::string& start) { return text.compare(0, start.size(), start) == 0; };
  if (begins("PK\x03\x04")) {
    return "is a ZIP archive, as FMUs are: name it in an experiment file (model.fmu.file)";
  }
  if (begins("\x89HDF")) {
    return "is an HDF5 file, not an experiment file in YAML";
  }
  if (const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
      first == std::string::npos || text[first] != '<') {
    return "";
  }
  for (const auto& [tag, kind] : {std::pair("<robot", "URDF"), {"<mujoco", "MJCF"}, {"<sdf", "SDF"}}) {
    if (text.find(tag) != std::string::npos) {
      return std::string("is a ") + kind +
             " file, which twinmap does not read: write its links as system.bodies of an experiment file";
    }
  }
  return "is an XML file, not an experiment file in YAML";
}

}  // namespace

YamlNode parseYaml(const std::string& text, const std::string& file) {
  requireText(text, file);
  std::istringstream stream(text);
  TreeBuilder builder(file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    TreeBuilder rest(file);
    if (parser.HandleNextDocument(rest)) {
      throw ExperimentError(rest.takeRoot().where, "",
                            "starts a second document; one file is one experiment");
    }
  } catch (const YAML::Exception& error) {
    throw ExperimentError(locate(file, error.mark), "", "is not valid YAML: " + describe(error, text));
  }
  YamlNode root = builder.takeRoot();
  if (root.kind == YamlNode::Kind::kNull) {
    root.where = {file, 1, 1, ""};
  }
  setKeyPaths(root, "");
  return root;
}

YamlNode loadYaml(const std::string& path) {
  const SourceLocation where{path, 0, 0, ""};
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ExperimentError(where, "", "is a folder; name the experiment file in it");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw ExperimentError(
        where, "",
        std::filesystem::exists(path, error) ? "cannot be read" : "does not exist; give the experiment file");
  }
  const std::string text = readStart(file, kLargestFile + 1);
  if (text.size() > kLargestFile) {
    throw ExperimentError(where, "", "is larger than 16 MiB, too large for an experiment file");
  }
  if (const std::string other = describeOtherFormat(text); !other.empty()) {
    throw ExperimentError(where, "", other);
  }
  YamlNode root = parseYaml(text, path);
  if (root.kind == YamlNode::Kind::kNull) {
    throw ExperimentError(root.where, "", "is empty: an experiment begins with its name, as 'name: cart'");
  }
  if (root.kind != YamlNode::Kind::kMap) {
    throw ExperimentError(root.where, describeValue(root),
                          "is not an experiment, which begins with its name, as 'name: cart'; a recording is "
                          "given after its experiment");
  }
  return root;
}

}  // namespace twinmap
