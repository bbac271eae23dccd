// What people write of the experiment file names the elements and kinds that there are:
// docs/reference/experiment-file against the schema. The tables of keys there are generated
// (scripts/reference).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "framework/experiment/tree/json_schema.hpp"

namespace twinmap {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::set<std::string>;

std::string readDocs(const std::string& name) {
  std::ifstream file(std::string(TWINMAP_SOURCE_DIR) + "/docs/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// What `pattern` captures first, each time it occurs.
std::vector<std::string> findAll(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    found.push_back((*match)[1].str());
  }
  return found;
}

/// The words within the code of a text: `...` and blocks.
Words listCodeWords(const std::string& text) {
  Words words;
  for (const std::string& code : findAll(text, "`+([^`]+)`+")) {
    for (const std::string& word : findAll(code, "([A-Za-z_][A-Za-z_0-9]*)")) {
      words.insert(word);
    }
  }
  return words;
}

/// The `...` of a table's cell, each up to its colon: `select: {features: [y]}` gives select.
Words listKeys(const std::string& cell) {
  const std::vector<std::string> keys = findAll(cell, "`([A-Za-z_0-9.]+)[^`]*`");
  return {keys.begin(), keys.end()};
}

struct Table {
  std::string header;                          ///< first cell
  std::vector<std::vector<std::string>> rows;  ///< cells
};

std::vector<Table> readTables(const std::string& text) {
  std::vector<Table> tables;
  std::istringstream lines(text);
  bool in_table = false;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells =
        line.rfind('|', 0) == 0 ? findAll(line, "\\| *([^|]*[^| ]|) *(?=\\|)") : std::vector<std::string>{};
    const bool begins = !in_table && !cells.empty();
    in_table = !cells.empty();
    if (begins) {
      tables.push_back({cells[0], {}});
    } else if (in_table && cells[0].rfind("--", 0) != 0) {
      tables.back().rows.push_back(cells);
    }
  }
  return tables;
}

/// The map's schema, where a scalar may stand for it.
const Json& getMap(const Json& schema) {
  if (schema.contains("type") || !schema.contains("oneOf")) {
    return schema;
  }
  const auto is_map = [](const Json& option) { return option.value("type", Json()) == "object"; };
  const auto found = std::find_if(schema["oneOf"].begin(), schema["oneOf"].end(), is_map);
  return found == schema["oneOf"].end() ? schema : *found;
}

/// Descends "a.*.b.[]": keys, the values of a map with free names, the items of a list.
const Json& getSchema(const Json& root, const std::string& path) {
  const Json* schema = &root;
  for (const std::string& step : findAll(path, "([^.]+)")) {
    const Json& map = getMap(*schema);
    schema = step == "*"    ? &map.at("additionalProperties")
             : step == "[]" ? &map.at("items")
                            : &map.at("properties").at(step);
  }
  return getMap(*schema);
}

Words listProperties(const Json& schema) {
  Words keys;
  const Json properties = schema.value("properties", Json::object());
  for (const auto& [key, value] : properties.items()) {
    keys.insert(key);
  }
  return keys;
}

/// Every key and every name of a choice below the schema.
void collectWords(const Json& schema, Words& words) {
  for (const auto& [key, value] : schema.items()) {
    if (key == "properties") {
      words.merge(listProperties(schema));
    }
    if (key == "enum") {
      words.insert(value.begin(), value.end());
    }
    if (value.is_structured()) {
      collectWords(value, words);
    }
  }
}

Words listFirstCells(const Table& table) {
  Words keys;
  for (const std::vector<std::string>& row : table.rows) {
    keys.merge(listKeys(row[0]));
  }
  return keys;
}

const Json& getRoot() {
  static const Json root = Json::parse(makeJsonSchema());
  return root;
}

/// What a table with this header describes: the keys (or names) of a part of the file.
struct Described {
  std::string page;
  std::string header;
  std::string path;
};

/// Tables of lists of maps: the keys of each map stand in the second column.
const std::vector<Described> kElementTables{
    {"system", "element", "system"},
    {"excitation", "terms", "excitation.*"},
    {"features", "kind of feature", "features.[]"},
    {"parameters", "kind of `prior`", "parameters.*.prior"},
    {"parameters", "entry of `priors`", "priors.[]"},
};

const std::vector<Described> kNameTables{
    {"system", "joint", "system.bodies.*.joint.type"},
    {"design", "method", "design.train.method"},
};

/// The one table with its header.
Table takeTable(const Described& described) {
  for (const Table& table : readTables(readDocs("reference/experiment-file/" + described.page + ".md"))) {
    if (table.header == described.header) {
      return table;
    }
  }
  ADD_FAILURE() << described.page << ".md has no table '" << described.header << "'";
  return {};
}

TEST(KeyTables, ListTheNamesThatThereAre) {
  for (std::size_t i = 0; i < kNameTables.size(); ++i) {
    const Json names = getSchema(getRoot(), kNameTables[i].path)["enum"];
    EXPECT_EQ(listFirstCells(takeTable(kNameTables[i])), Words(names.begin(), names.end()));
  }
}

TEST(KeyTables, ListTheKeysOfElementsAndNoOthers) {
  for (std::size_t i = 0; i < kElementTables.size(); ++i) {
    const Json& parent = getSchema(getRoot(), kElementTables[i].path);
    for (const std::vector<std::string>& row : takeTable(kElementTables[i]).rows) {
      const std::string element = *listKeys(row[0]).begin();
      ASSERT_EQ(listProperties(parent).count(element), 1u) << element;
      const Json& in_parent = getSchema(parent, element);
      const Json& schema = in_parent.contains("items") ? getSchema(in_parent, "[]") : in_parent;
      Words known;
      collectWords(schema, known);
      const Words documented = listCodeWords(row[1]);
      Words keys = listProperties(schema);
      keys.erase("name");  // of every force element: said once, above the table
      EXPECT_TRUE(std::includes(documented.begin(), documented.end(), keys.begin(), keys.end())) << element;
      EXPECT_TRUE(std::includes(known.begin(), known.end(), documented.begin(), documented.end())) << element;
    }
  }
}

}  // namespace
}  // namespace twinmap
