#include "framework/report/sections/sweep_groups.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {
namespace {

std::string makeVariant(const CsvTable& sweep, std::size_t row) {
  std::string variant;
  for (const std::string& key : findVariedKeys(sweep)) {
    if (key != kSizeKey && key != kNoiseKey && key != kSeedKey) {
      variant +=
          (variant.empty() ? "" : ", ") + key.substr(key.rfind('.') + 1) + "=" + sweep.getText(row, key);
    }
  }
  return variant;
}

bool isSame(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

SweepGroup& findGroup(const SweepGroup& wanted, std::vector<SweepGroup>& groups) {
  const auto matches = [&](const SweepGroup& group) {
    return group.variant == wanted.variant && group.parameter == wanted.parameter &&
           isSame(group.size, wanted.size) && isSame(group.noise, wanted.noise);
  };
  const auto found = std::find_if(groups.begin(), groups.end(), matches);
  if (found != groups.end()) {
    return *found;
  }
  groups.push_back(wanted);
  return groups.back();
}

}  // namespace

std::vector<std::string> findVariedKeys(const CsvTable& sweep) {
  std::vector<std::string> keys;
  for (const std::string& column : sweep.columns) {
    if (column.find('.') != std::string::npos || column == kSeedKey) {
      keys.push_back(column);
    }
  }
  return keys;
}

std::vector<SweepGroup> groupCases(const CsvTable& sweep) {
  std::vector<SweepGroup> groups;
  for (std::size_t row = 0; row < sweep.rows.size(); ++row) {
    const double sd = sweep.getNumber(row, "sd_pct");
    if (!std::isfinite(sd)) {
      continue;  // a case that failed
    }
    SweepGroup wanted;
    wanted.variant = makeVariant(sweep, row);
    wanted.parameter = sweep.getText(row, "parameter");
    wanted.size = sweep.getNumber(row, kSizeKey);
    wanted.noise = sweep.getNumber(row, kNoiseKey);
    wanted.lowest = HUGE_VAL;
    wanted.highest = -HUGE_VAL;
    SweepGroup& group = findGroup(wanted, groups);
    ++group.seeds;
    group.mean += (sd - group.mean) / group.seeds;
    group.lowest = std::min(group.lowest, sd);
    group.highest = std::max(group.highest, sd);
    group.coverage += (sweep.getNumber(row, "coverage95") - group.coverage) / group.seeds;
    group.limit += (sweep.getNumber(row, "limit_pct") - group.limit) / group.seeds;
  }
  return groups;
}

}  // namespace twinmap
