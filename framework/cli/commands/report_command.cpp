#include <algorithm>
#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/report/sections/report.hpp"

namespace twinmap::cli {

void report(const ReportArguments& arguments) {
  const std::vector<std::filesystem::path> folders(arguments.folders.begin(), arguments.folders.end());
  const std::filesystem::path by_default = folders.size() == 1 ? folders[0] : "results/report";
  const std::filesystem::path out = arguments.out.empty() ? by_default : std::filesystem::path(arguments.out);
  const Report made = makeReport(folders);
  writeReport(out, made);
  std::cerr << "Report: " << (out / "report.html").string() << "\n";
  requireGates(made.gates, arguments.fail_on_gates);
}

void requireGates(const std::vector<GateResult>& gates, bool fail) {
  for (const GateResult& gate : gates) {
    if (!gate.passed) {
      std::cerr << "twinmap: gate failed: " << gate.condition << " (" << gate.found << ")\n";
    }
  }
  const auto passed = [](const GateResult& gate) { return gate.passed; };
  if (fail && !std::all_of(gates.begin(), gates.end(), passed)) {
    throw GatesFailed("gates failed");
  }
}

}  // namespace twinmap::cli
