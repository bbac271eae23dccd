#pragma once

#include <vector>

#include "framework/cli/commands/commands.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap::cli {

enum class InferFormat { kTable, kCsv, kJson };

/// As --json, --follow or --csv ask for it, or a table.
InferFormat chooseFormat(const InferArguments& arguments);

/// Prints one estimate after another to the standard output.
class InferredPrinter {
 public:
  /// parameters: must outlive the object. refines, samples: what makeInferenceCsvHeader() takes.
  InferredPrinter(InferFormat format, const std::vector<ParameterSpec>& parameters, bool refines,
                  bool samples)
      : format_(format), parameters_(parameters), refines_(refines), samples_(samples) {}

  InferFormat getFormat() const { return format_; }
  /// The header of CSV, before anything else.
  void printHeader() const;
  /// is_first: whether no table stands before it.
  void print(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& features,
             bool is_first) const;

 private:
  const InferFormat format_;
  const std::vector<ParameterSpec>& parameters_;
  const bool refines_, samples_;
};

}  // namespace twinmap::cli
