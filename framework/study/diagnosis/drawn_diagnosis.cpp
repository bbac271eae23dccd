#include "framework/study/diagnosis/drawn_diagnosis.hpp"

namespace twinmap {

void RecordingTable::add(std::size_t recording, const NamedColumns& columns) {
  const auto rows = static_cast<std::size_t>(columns.front().second.size());
  recordings_.insert(recordings_.end(), rows, std::to_string(recording + 1));
  for (const auto& [name, values] : columns) {
    std::vector<double>& column = columns_[name];
    column.insert(column.end(), values.begin(), values.end());
  }
}

DataTable RecordingTable::make() const {
  DataTable table;
  table.add("recording", recordings_);
  for (const auto& [name, values] : columns_) {
    table.add(name, values);
  }
  return table;
}

void addRecordingChoice(const std::vector<std::string>& names, Figure& figure) {
  if (names.size() < 2) {
    for (Panel& panel : figure.panels) {
      panel.texts["recording"] = "1";
    }
    return;
  }
  Choice choice{"recording", "recording", {}, 0};
  for (std::size_t k = 0; k < names.size(); ++k) {
    choice.options.push_back({std::to_string(k + 1), names[k], {}});
  }
  figure.choices.push_back(std::move(choice));
}

std::string makeSpeedUnit(const ForcedCoordinate& coordinate) {
  return std::string(coordinate.getUnit()) + "/s";
}

}  // namespace twinmap
