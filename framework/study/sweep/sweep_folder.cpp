#include "framework/study/sweep/sweep_folder.hpp"

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/results/run_state.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFailedCases = "failed_cases.csv";

}  // namespace

fs::path getCaseFolder(const fs::path& sweep, const SweepCase& sweep_case) {
  return sweep / "cases" / sweep_case.name;
}

std::vector<bool> findComplete(const fs::path& sweep, const std::vector<SweepCase>& cases) {
  std::vector<bool> complete;
  for (const SweepCase& one : cases) {
    complete.push_back(isComplete(getCaseFolder(sweep, one)));
  }
  return complete;
}

std::string makeCaseCommand(const fs::path& case_folder, const fs::path& store) {
  return "twinmap run " + quoteForShell((case_folder / "resolved.yaml").string()) + " --out " +
         quoteForShell(case_folder.string()) + " --store " + quoteForShell(store.string());
}

void writeFailedCases(const fs::path& sweep, const std::vector<FailedCase>& failures) {
  std::string csv = "case,reason,command\n";
  for (const FailedCase& failure : failures) {
    csv +=
        escapeCsv(failure.name) + "," + escapeCsv(failure.reason) + "," + escapeCsv(failure.command) + "\n";
  }
  writeTextFile(sweep / kFailedCases, csv);
}

std::vector<std::string> readFailedCases(const fs::path& sweep) {
  const CsvTable table = readCsvFile(sweep / kFailedCases);
  std::vector<std::string> names;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    names.push_back(table.getText(row, "case"));
  }
  return names;
}

}  // namespace twinmap
