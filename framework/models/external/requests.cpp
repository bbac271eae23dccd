#include "framework/models/external/requests.hpp"

#include <fmt/format.h>

#include "framework/base/json/json.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

template <class Named>
std::string getVariable(const Named& item) {
  return (item.variable ? *item.variable : item.name).text;
}

std::string quote(const std::string& text) {
  return formatJson(text);
}

std::string join(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) {
    text += (text.empty() ? "" : ",") + item;
  }
  return text;
}

std::string writeNames(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) {
    quoted.push_back(quote(name));
  }
  return "[" + join(quoted) + "]";
}

/// Numbers in the fewest digits that read back the same.
template <class Numbers>
std::string writeNumbers(const Numbers& numbers) {
  std::string text = "[";
  for (const double number : numbers) {
    fmt::format_to(std::back_inserter(text), text.size() > 1 ? ",{}" : "{}", number);
  }
  return text + "]";
}

std::string writeSignal(const ExcitationTable& table, Eigen::Index signal) {
  std::vector<std::string> pieces;
  for (Eigen::Index i = 0; i + 1 < static_cast<Eigen::Index>(table.phases.size()); ++i) {
    pieces.push_back(writeNumbers(std::vector<double>{table.phases[i], table.phases[i + 1],
                                                      table.begin(i, signal), table.end(i, signal)}));
  }
  const Eigen::VectorXd values = table.values.col(signal);
  return R"({"values":)" + writeNumbers(values) + R"(,"pieces":[)" + join(pieces) + "]}";
}

std::string writeExcitation(const ProgramNames& names, const ExcitationTable& table) {
  std::vector<std::string> signals;
  for (std::size_t i = 0; i < names.signals.size(); ++i) {
    signals.push_back(quote(names.signals[i]) + ":" + writeSignal(table, static_cast<Eigen::Index>(i)));
  }
  return R"("excitation":{"times":)" + writeNumbers(table.times) + R"(,"signals":{)" + join(signals) + "}}";
}

}  // namespace

ProgramNames collectProgramNames(const ModelSpec& model) {
  ProgramNames names;
  for (const ParameterSpec& parameter : collectSampled(model)) {
    names.values.push_back(getVariable(parameter));
  }
  for (const ConstantSpec& constant : model.constants) {
    if (constant.variable) {
      names.values.push_back(constant.variable->text);
    }
  }
  for (const SignalSpec& signal : model.excitation) {
    names.signals.push_back(getVariable(signal));
  }
  for (const OutputSpec& output : model.outputs) {
    names.outputs.push_back(getVariable(output));
  }
  return names;
}

std::string writeHello(const ProgramNames& names, const ResponseLayout& layout, double duration,
                       const ExcitationTable& excitation) {
  return fmt::format(R"({{"twinmap":{},"parameters":{},"outputs":{},"duration":{},"times":{},{}}})",
                     kProtocolVersion, writeNames(names.values), writeNames(names.outputs), duration,
                     writeNumbers(layout.times), writeExcitation(names, excitation));
}

std::string writeRequest(const ProgramNames& names, const std::vector<double>& values,
                         const ExcitationTable* excitation) {
  std::string text = R"({"parameters":{)";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i > 0 ? "," : "") + quote(names.values[i]) + ":" + fmt::format("{}", values[i]);
  }
  return text + "}" + (excitation != nullptr ? "," + writeExcitation(names, *excitation) : "") + "}";
}

std::string writeBatch(const std::vector<std::string>& requests) {
  return R"({"samples":[)" + join(requests) + "]}";
}

}  // namespace twinmap
