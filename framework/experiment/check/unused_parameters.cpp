#include "framework/experiment/check/unused_parameters.hpp"

#include <cctype>
#include <set>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/tree/write_value.hpp"

namespace twinmap {
namespace {

bool isOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

void collectWords(const std::string& text, std::set<std::string>& words) {
  std::string word;
  for (const char c : text + ' ') {
    if (isOfName(c)) {
      word += c;
    } else if (!word.empty()) {
      words.insert(std::move(word));
      word.clear();
    }
  }
}

void collectWords(const YamlNode& node, std::set<std::string>& words) {
  collectWords(node.scalar, words);
  for (const YamlNode& item : node.items) {
    collectWords(item, words);
  }
  for (const YamlEntry& entry : node.entries) {
    if (entry.key != "description" && entry.key != "unit") {
      collectWords(entry.key, words);
      collectWords(entry.value, words);
    }
  }
}

}  // namespace

std::vector<std::string> listUnused(const YamlNode& experiment, const std::string& section) {
  // what names parameters without using them
  static const std::set<std::string> kElsewhere = {"name",       "description", "parameters", "nuisance",
                                                   "priors",     "derived",     "design",     "inverse_map",
                                                   "evaluation", "gates",       "report",     "sweep"};
  const YamlNode* parameters = experiment.find(section);
  if (parameters == nullptr || experiment.find("system") == nullptr) {
    return {};
  }
  std::set<std::string> words;
  for (const YamlEntry& entry : experiment.entries) {
    if (kElsewhere.count(entry.key) == 0) {
      collectWords(entry.value, words);
    }
  }
  std::vector<std::string> unused;
  for (const YamlEntry& parameter : parameters->entries) {
    if (words.count(parameter.key) == 0) {
      unused.push_back(parameter.key);
    }
  }
  return unused;
}

std::vector<std::string> listUnused(ExperimentSpec experiment, const std::string& section) {
  for (SignalSpec& signal : experiment.model.excitation) {
    for (TableSpec& table : signal.tables) {  // numbers alone, as many as a recording has
      table.times.clear();
      table.values.clear();
    }
  }
  return listUnused(writeValue(experiment), section);
}

std::vector<std::string> listUnusedParameters(const YamlNode& experiment) {
  std::vector<std::string> sentences;
  for (const std::string& name : listUnused(experiment, "parameters")) {
    sentences.push_back(
        "parameters." + name +
        ": nothing uses this parameter: name it in an expression of the system, or take it out");
  }
  return sentences;
}

}  // namespace twinmap
