#include "framework/data/measurement/trigger.hpp"

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/trim.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"

namespace twinmap {

std::optional<Trigger> findTrigger(const MeasurementStartSpec& start) {
  double stamp = 0.0;
  if (!start.when || start.when->text == "first" || parseTimeStamp(start.when->text, stamp)) {
    return std::nullopt;
  }
  const std::string& text = start.when->text;
  const std::size_t sign = text.find_last_of("<>");
  Trigger trigger;
  if (sign != std::string::npos) {
    trigger = {trim(text.substr(0, sign)), text[sign] == '>', 0.0};
  }
  if (trigger.column.empty() || !parseLiteral(trim(text.substr(sign + 1)), trigger.level)) {
    throw ExperimentError(start.when->where, text,
                          "must be 'first', a date and time such as 2026-11-26T10:00:00Z, or a column and a "
                          "number, such as 'F > 0.5'");
  }
  return trigger;
}

}  // namespace twinmap
