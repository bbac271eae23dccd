#include "framework/serve/twin/track_service.hpp"

#include "framework/base/json/json.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"

namespace twinmap::serve {
namespace {

/// What stands for a file where the client names none.
constexpr const char* kUnnamed = "measurement";

/// The header, and the rows of the newest measurements; those of one have the same first cell.
std::string keepNewest(const std::string& csv, std::size_t most) {
  const std::size_t header = csv.find('\n') + 1;
  std::size_t begin = csv.size();
  std::string last;
  for (std::size_t kept = 0; begin > header;) {
    const std::size_t end_above = csv.rfind('\n', begin - 2);
    const std::size_t row = end_above == std::string::npos ? 0 : end_above + 1;
    const std::string measurement = csv.substr(row, csv.find(',', row) - row);
    if (row < header || (measurement != last && ++kept > most)) {
      break;
    }
    last = measurement;
    begin = row;
  }
  return csv.substr(0, header) + csv.substr(begin);
}

}  // namespace

double parseAt(const std::string& text) {
  double seconds = 0.0;
  if (!parseTime(text, seconds)) {
    throw ExperimentError("at: '" + text + "' must be a date and time, or seconds since 1970" +
                          "\n  such as 2026-11-26T10:00:00Z");
  }
  return seconds;
}

TrackService::TrackService(const TwinSource& source, std::filesystem::path state, TrackOptions options)
    : session_(source, std::move(state), std::move(options)) {}

Json TrackService::answer(const PostedMeasurement& posted) {
  MeasurementContext context;
  context.trial = posted.trial;
  if (!posted.at.empty()) {
    context.at = parseAt(posted.at);
  }
  return session_.update(posted.text, posted.name.empty() ? kUnnamed : posted.name, context);
}

void TrackService::commit() {
  session_.commit();
}

Json TrackService::getState() const {
  return session_.getState();
}

std::string TrackService::makeHistory(std::size_t most) const {
  return keepNewest(session_.makeHistory(), most);
}

std::string TrackService::makePage() const {
  return session_.makePage();
}

}  // namespace twinmap::serve
