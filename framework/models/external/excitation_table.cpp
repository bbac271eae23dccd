#include "framework/models/external/excitation_table.hpp"

#include <cmath>

namespace twinmap {

bool ExcitationTable::operator==(const ExcitationTable& other) const {
  return phases == other.phases && values == other.values && begin == other.begin && end == other.end;
}

ExcitationTable calcExcitationTable(Excitation& excitation, const Eigen::VectorXd& times, double duration) {
  ExcitationTable table;
  table.times = times;
  table.phases = {0.0};
  for (const double event : excitation.calcEventTimes(duration)) {
    table.phases.push_back(event);
  }
  table.phases.push_back(duration);
  const auto phases = static_cast<Eigen::Index>(table.phases.size()) - 1;
  const Eigen::Index signals = excitation.getSignalCount();
  table.values.resize(times.size(), signals);
  table.begin.resize(phases, signals);
  table.end.resize(phases, signals);
  std::vector<double> values(signals);
  const auto sample = [&](double time, auto row) {
    excitation.calcValues(time, values);
    row = Eigen::Map<const Eigen::RowVectorXd>(values.data(), signals);
  };
  Eigen::Index next = 0;
  for (Eigen::Index phase = 0; phase < phases; ++phase) {
    excitation.beginPhase(table.phases[phase]);
    sample(table.phases[phase], table.begin.row(phase));
    sample(table.phases[phase + 1], table.end.row(phase));
    const bool last = phase + 1 == phases;
    for (; next < times.size() && (last || times[next] < table.phases[phase + 1]); ++next) {
      sample(times[next], table.values.row(next));
    }
  }
  excitation.mute();
  return table;
}

Eigen::VectorXd makeExcitationTimes(double interval, double duration) {
  constexpr double kAgreement = 1e-9;  // of decimal numbers that are to divide each other
  const auto whole = static_cast<Eigen::Index>(std::floor(duration / interval + kAgreement));
  const bool ends_there = duration - static_cast<double>(whole) * interval <= kAgreement * duration;
  Eigen::VectorXd times(whole + (ends_there ? 1 : 2));
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    times[i] = std::min(static_cast<double>(i) * interval, duration);
  }
  return times;
}

}  // namespace twinmap
