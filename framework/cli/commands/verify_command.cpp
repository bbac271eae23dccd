#include <fmt/core.h>

#include <iostream>
#include <stdexcept>

#include "framework/cli/commands/commands.hpp"
#include "framework/store/finished_run.hpp"
#include "framework/study/verification/verification.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

/// The run itself; of a sweep some of its cases, or all.
std::vector<fs::path> chooseFolders(const VerifyArguments& arguments) {
  constexpr int kCases = 3, kStream = 2;
  const std::vector<fs::path> cases = listCases(arguments.folder);
  if (cases.empty()) {
    return {arguments.folder};
  }
  if (arguments.all) {
    return cases;
  }
  std::vector<fs::path> chosen;
  for (const int i : chooseSome(kCases, static_cast<int>(cases.size()), arguments.seed, kStream)) {
    chosen.push_back(cases[static_cast<std::size_t>(i)]);
  }
  return chosen;
}

void printVerification(const Verification& verification) {
  std::cout << verification.folder.string() << "\n";
  for (const std::string& difference : verification.build_differences) {
    std::cout << "  note     another build or machine made this run, so that bits may differ: " << difference
              << "\n";
  }
  for (const CheckResult& check : verification.checks) {
    std::cout << (check.difference.empty() ? "  ok       " : "  differs  ") << check.name << "\n";
    if (!check.difference.empty()) {
      std::cout << "           " << check.difference << "\n";
    }
  }
  for (const std::string& note : verification.notes) {
    std::cout << "  note     " << note << "\n";
  }
  std::cout << std::flush;
}

}  // namespace

void verify(const VerifyArguments& arguments) {
  VerifyOptions options;
  options.samples = arguments.samples;
  options.seed = arguments.seed;
  options.all = arguments.all;
  options.threads = arguments.threads;
  int checks = 0, differences = 0;
  for (const fs::path& folder : chooseFolders(arguments)) {
    const Verification verification = verifyRun(folder, options);
    printVerification(verification);
    checks += static_cast<int>(verification.checks.size());
    differences += verification.countDifferences();
  }
  if (!arguments.all) {
    std::cout << "Samples were chosen with --seed " << arguments.seed << ".\n";
  }
  if (differences > 0) {
    throw std::runtime_error(fmt::format("{} of {} checks found a difference", differences, checks));
  }
}

}  // namespace twinmap::cli
