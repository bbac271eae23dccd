#include "framework/cli/commands/measurements/inferred_printer.hpp"

#include <iostream>

#include "framework/inference/text/inference_text.hpp"

namespace twinmap::cli {

InferFormat chooseFormat(const InferArguments& arguments) {
  return arguments.json || arguments.follow ? InferFormat::kJson
         : arguments.csv                    ? InferFormat::kCsv
                                            : InferFormat::kTable;
}

void InferredPrinter::printHeader() const {
  if (format_ == InferFormat::kCsv) {
    std::cout << makeInferenceCsvHeader(refines_, samples_);
  }
}

void InferredPrinter::print(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& features,
                            bool is_first) const {
  switch (format_) {
    case InferFormat::kTable:
      std::cout << (is_first ? "" : "\n") << makeInferenceTable(inferred, parameters_, features);
      break;
    case InferFormat::kCsv:
      std::cout << makeInferenceCsvRows(inferred, parameters_, samples_);
      break;
    case InferFormat::kJson:
      std::cout << makeInferenceJson(inferred, parameters_, features) << '\n';
      break;
  }
}

}  // namespace twinmap::cli
