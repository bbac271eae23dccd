#include "framework/models/external/answer.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "framework/base/json/json.hpp"
#include "framework/models/external/requests.hpp"

namespace twinmap {
namespace {

/// The beginning of a line, human-readable.
std::string shorten(const std::string& line) {
  constexpr std::size_t kMax = 80;
  return line.size() <= kMax ? line : line.substr(0, kMax) + "...";
}

/// NaN and Infinity, which many languages write and JSON does not know, as null: outside texts.
std::string replaceNonFinite(const std::string& line) {
  std::string result;
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    in_text = in_text != (line[i] == '"' && (i == 0 || line[i - 1] != '\\'));
    bool replaced = false;
    for (const char* word : {"-Infinity", "Infinity", "-NaN", "NaN"}) {
      const std::string text = word;
      if (!in_text && !replaced && line.compare(i, text.size(), text) == 0) {
        result += "null";
        i += text.size() - 1;
        replaced = true;
      }
    }
    if (!replaced) {
      result += line[i];
    }
  }
  return result;
}

Json parse(const std::string& line) {
  Json answer = tryParseJson(line);
  if (answer.is_discarded()) {
    answer = tryParseJson(replaceNonFinite(line));
  }
  if (!answer.is_object()) {
    throw ProtocolError("the program's answer is not a JSON object: " + shorten(line));
  }
  return answer;
}

/// Why the values of an output cannot be taken, or "".
std::string readOutput(const Json& values, const std::string& name, const ResponseLayout& layout,
                       Eigen::Ref<Eigen::VectorXd> rows) {
  const bool single = values.is_number();  // as MATLAB and Octave write a list of one
  const auto count = static_cast<Eigen::Index>(values.size());
  if (!single && !values.is_array()) {
    return fmt::format("output '{}' is not a list of numbers: {}", name, shorten(formatJson(values)));
  }
  if (count != rows.size()) {
    return fmt::format("output '{}' has {} value{} instead of {}, one for each time", name, count,
                       count == 1 ? "" : "s", rows.size());
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Json& value = single ? values : values[static_cast<std::size_t>(i)];
    rows[i] = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(rows[i])) {
      return fmt::format("output '{}' is not finite at t = {:g} s", name, layout.times[i]);
    }
  }
  return "";
}

std::string listNames(const Json& outputs) {
  std::string text;
  for (const auto& item : outputs.items()) {
    text += (text.empty() ? "'" : ", '") + item.key() + "'";
  }
  return text.empty() ? "nothing" : shorten(text);
}

SampleStatus readSample(const Json& answer, const std::vector<std::string>& names,
                        const ResponseLayout& layout, Eigen::Ref<Eigen::VectorXd> response) {
  if (const auto failed = answer.find("failed"); failed != answer.end()) {
    return {false, failed->is_string() ? failed->get<std::string>() : formatJson(*failed)};
  }
  const auto outputs = answer.find("outputs");
  if (outputs == answer.end() || !outputs->is_object()) {
    throw ProtocolError("the program's answer has neither 'outputs' nor 'failed': " +
                        shorten(formatJson(answer)));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto values = outputs->find(names[i]);
    const Eigen::Index first = layout.getRow(static_cast<Eigen::Index>(i), 0);
    const std::string failure =
        values == outputs->end()
            ? fmt::format("the answer lacks output '{}'; it has {}", names[i], listNames(*outputs))
            : readOutput(*values, names[i], layout, response.segment(first, layout.times.size()));
    if (!failure.empty()) {
      return {false, failure};
    }
  }
  return {};
}

}  // namespace

std::string writeHelloAnswer() {
  return fmt::format(R"({{"twinmap": {}}})", kProtocolVersion);
}

void checkHello(const std::string& line) {
  const Json answer = parse(line);
  const auto version = answer.find("twinmap");
  if (version == answer.end() || *version != kProtocolVersion) {
    throw ProtocolError(
        fmt::format("the program's first answer must be {}, not {}", writeHelloAnswer(), shorten(line)));
  }
}

SampleStatus readAnswer(const std::string& line, const std::vector<std::string>& names,
                        const ResponseLayout& layout, Eigen::Ref<Eigen::VectorXd> response) {
  return readSample(parse(line), names, layout, response);
}

void readAnswers(const std::string& line, const std::vector<std::string>& names, const ResponseLayout& layout,
                 Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  const Json answer = parse(line);
  const auto samples = answer.find("samples");
  if (samples == answer.end() || !samples->is_array() ||
      static_cast<Eigen::Index>(samples->size()) != responses.cols()) {
    throw ProtocolError(
        fmt::format("the program's answer to a batch of {} must have as many 'samples'", responses.cols()));
  }
  for (Eigen::Index i = 0; i < responses.cols(); ++i) {
    statuses[i] = readSample((*samples)[static_cast<std::size_t>(i)], names, layout, responses.col(i));
  }
}

}  // namespace twinmap
