#include "framework/tracking/track_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/interval_factor.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr const char* kStyle =
    ":root{color-scheme:light dark;--line:#0072b2;--past:#d55e00;--ink:#222;--faint:#767676;--back:#fff}"
    "@media(prefers-color-scheme:dark){:root{--line:#56b4e9;--past:#f0a05a;--ink:#eee;--faint:#a0a0a0;--back:"
    "#16181c}}"
    "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:0 auto;padding:1rem;color:var(--ink);"
    "background:var(--back)}svg{width:100%;height:auto}text{fill:var(--ink);font-size:12px}"
    "table{border-collapse:collapse}td,th{padding:.2rem .6rem;text-align:left;border-bottom:1px solid "
    "var(--faint)}.wide{overflow-x:auto}";

constexpr double kWidth = 800.0, kHeight = 240.0, kLeft = 90.0, kRight = 12.0, kTop = 12.0, kBottom = 30.0;
constexpr Index kMostDrawn = 2000;  // points that a screen can show; of more, evenly chosen

/// From data to the picture.
struct Frame {
  double first, last, lowest, highest;

  double x(double time) const {
    return kLeft + (time - first) / std::max(last - first, 1e-300) * (kWidth - kLeft - kRight);
  }
  double y(double value) const {
    return kHeight - kBottom -
           (value - lowest) / std::max(highest - lowest, 1e-300) * (kHeight - kTop - kBottom);
  }
};

/// One parameter's numbers at the measurements that are drawn.
struct Drawn {
  std::vector<double> times, mean, lower, upper, smoothed, smoothed_lower, smoothed_upper;
};

Drawn collect(const TrackCourse& course, const TrackSpace& space, Index j) {
  Drawn drawn;
  const auto count = static_cast<Index>(course.records.size());
  const Index step = (count + kMostDrawn - 1) / kMostDrawn;
  for (Index i = 0; i < count; i += std::max<Index>(step, 1)) {
    const auto value = [&](const tracking::Course& one, double factor) {
      return space.toValue(j, one.means(j, i) + factor * kNormal95 * one.stddevs(j, i));
    };
    const auto& [used, filtered, smoothed] = course.whole;
    drawn.times.push_back(course.records[static_cast<std::size_t>(i)].measurement.time);
    drawn.mean.push_back(value(filtered, 0.0));
    drawn.lower.push_back(value(filtered, -1.0));
    drawn.upper.push_back(value(filtered, 1.0));
    drawn.smoothed.push_back(value(smoothed, 0.0));
    drawn.smoothed_lower.push_back(value(smoothed, -1.0));
    drawn.smoothed_upper.push_back(value(smoothed, 1.0));
  }
  return drawn;
}

/// What the smoothed band and most of the filtered one need: the first measurements know too little.
Frame makeFrame(const Drawn& drawn) {
  const auto [lowest, highest] = std::minmax_element(drawn.mean.begin(), drawn.mean.end());
  Frame frame{drawn.times.front(), drawn.times.back(), *lowest, *highest};
  for (std::size_t i = 0; i < drawn.times.size(); ++i) {
    frame.lowest = std::min(frame.lowest, drawn.smoothed_lower[i]);
    frame.highest = std::max(frame.highest, drawn.smoothed_upper[i]);
  }
  return frame;
}

std::string makeBand(const Drawn& drawn, const Frame& frame, const std::vector<double>& lower,
                     const std::vector<double>& upper, const char* color) {
  std::string path = "M";
  for (std::size_t i = 0; i < drawn.times.size(); ++i) {
    path +=
        fmt::format("{:.1f} {:.1f} ", frame.x(drawn.times[i]), std::clamp(frame.y(upper[i]), 0.0, kHeight));
  }
  for (std::size_t i = drawn.times.size(); i-- > 0;) {
    path +=
        fmt::format("{:.1f} {:.1f} ", frame.x(drawn.times[i]), std::clamp(frame.y(lower[i]), 0.0, kHeight));
  }
  return fmt::format("<path d='{}z' fill='var({})' opacity='.25'/>", path, color);
}

std::string makeCurve(const Drawn& drawn, const Frame& frame, const std::vector<double>& values,
                      const char* color) {
  std::string points;
  for (std::size_t i = 0; i < drawn.times.size(); ++i) {
    points += fmt::format("{:.1f},{:.1f} ", frame.x(drawn.times[i]), frame.y(values[i]));
  }
  return fmt::format("<polyline points='{}' fill='none' stroke='var({})' stroke-width='1.5'/>", points,
                     color);
}

std::string makeRule(double x1, double y1, double x2, double y2, const char* dash) {
  return fmt::format(
      "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='var(--ink)' stroke-dasharray='{}'/>", x1,
      y1, x2, y2, dash);
}

std::string makeAxes(const Frame& frame) {
  std::string axes;
  for (const double part : {0.0, 0.5, 1.0}) {
    const double value = frame.lowest + part * (frame.highest - frame.lowest);
    const double time = frame.first + part * (frame.last - frame.first);
    axes += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{}</text>", kLeft - 6.0,
                        frame.y(value) + 4.0, toShortText(value, 4));
    axes += fmt::format("<text x='{:.1f}' y='{}' text-anchor='{}'>{}</text>", frame.x(time), kHeight - 8.0,
                        part == 0.0 ? "start" : (part == 1.0 ? "end" : "middle"), toShortText(time, 10));
  }
  return axes;
}

std::string makeMarks(const Frame& frame, const TrackPoint& point, const TrackView& view, Index j) {
  std::string marks;
  for (const TrackAlarm& alarm : point.alarms) {
    if (alarm.is_of_several || alarm.change.parameter == j) {
      const double x = frame.x(alarm.is_of_several ? alarm.announced : alarm.change.time);
      marks += makeRule(x, kTop, x, kHeight - kBottom, "6 3");
    }
  }
  for (std::size_t l = 0; view.tracking != nullptr && l < view.tracking->limits.size(); ++l) {
    const LimitSpec& limits = view.tracking->limits[l];
    for (const std::optional<double>& limit : {limits.min, limits.max}) {
      if (limit && limits.name.text == view.parameters[static_cast<std::size_t>(j)].name.text &&
          *limit >= frame.lowest && *limit <= frame.highest) {
        marks += makeRule(kLeft, frame.y(*limit), kWidth - kRight, frame.y(*limit), "2 3");
      }
    }
  }
  return marks;
}

std::string makeFigure(const TrackCourse& course, const TrackPoint& point, const TrackView& view, Index j) {
  const ParameterSpec& parameter = view.parameters[static_cast<std::size_t>(j)];
  const std::string label =
      escapeHtml(parameter.name.text + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]"));
  const Drawn drawn = collect(course, view.space, j);
  const Frame frame = makeFrame(drawn);
  return fmt::format(
      "<h2>{0}</h2><svg viewBox='0 0 {1} {2}' role='img' aria-label='{0} over time, with 95 % "
      "bands'>{3}{4}{5}{6}"
      "{7}{8}</svg>",
      label, kWidth, kHeight, makeBand(drawn, frame, drawn.lower, drawn.upper, "--past"),
      makeBand(drawn, frame, drawn.smoothed_lower, drawn.smoothed_upper, "--line"),
      makeCurve(drawn, frame, drawn.mean, "--past"), makeCurve(drawn, frame, drawn.smoothed, "--line"),
      makeMarks(frame, point, view, j), makeAxes(frame));
}

std::string showCell(const Json& value) {
  if (value.is_number()) {
    return toShortText(value.get<double>(), 6);
  }
  return value.is_string() ? escapeHtml(value.get<std::string>())
                           : (value.is_null() ? "never" : value.dump());
}

/// Of objects, those members.
std::string makeTable(const Json& rows, const std::vector<std::pair<std::string, std::string>>& columns) {
  std::string html = "<div class='wide' tabindex='0'><table><tr>";
  for (const auto& [heading, key] : columns) {
    html += "<th scope='col'>" + escapeHtml(heading) + "</th>";
  }
  html += "</tr>";
  for (const Json& row : rows) {
    html += "<tr>";
    for (const auto& [heading, key] : columns) {
      html += "<td>" + (row.contains(key) ? showCell(row.at(key)) : "") + "</td>";
    }
    html += "</tr>";
  }
  return html + "</table></div>";
}

std::string makeAlarmText(const Json& alarms) {
  if (alarms.empty()) {
    return "<p>No change was announced.</p>";
  }
  std::string html = makeTable(alarms, {{"parameter", "parameter"},
                                        {"since", "time"},
                                        {"announced", "announced"},
                                        {"size", "size"},
                                        {"sd", "sd"},
                                        {"unit", "unit"},
                                        {"probability", "probability"}});
  for (const Json& alarm : alarms) {
    const Json& verdict = alarm.at("drift_or_model");
    const std::string of =
        fmt::format("{} at {}: ", showCell(alarm.at(alarm.contains("of") ? "of" : "parameter")),
                    showCell(alarm.at("time")));
    if (verdict.contains("test")) {
      html += fmt::format("<p>{}as likely follows something else; {}.</p>", of, showCell(verdict["test"]));
    }
    if (verdict.contains("diagnosis")) {
      html += fmt::format("<p>{}{}.</p>", of, showCell(verdict["diagnosis"]["says"]));
    }
  }
  return html;
}

std::string makeLastMeasurements(const TrackCourse& course) {
  constexpr std::size_t kShown = 20;
  Json rows = Json::array();
  for (std::size_t i = course.records.size(); i-- > 0 && rows.size() < kShown;) {
    const TrackRecord& record = course.records[i];
    rows.push_back({{"time", record.measurement.time},
                    {"source", record.source},
                    {"status", record.status},
                    {"used", course.whole.used[i] ? "yes" : "no"}});
  }
  return makeTable(rows,
                   {{"time", "time"}, {"measurement", "source"}, {"status", "status"}, {"used", "used"}});
}

}  // namespace

std::string makeTrackPage(const std::string& name, const TrackCourse& course, const TrackPoint& point,
                          const TrackView& view) {
  const Json state = makeTrackState(point, view);
  std::string body = fmt::format(
      "<h1>{}</h1><p>{} measurements, status {}. Blue: what all measurements say of each time; orange: what "
      "was "
      "known then. Bands hold 95 %. Dashed upright lines are changes, dotted ones limits.</p>",
      escapeHtml(name), course.records.size(), showCell(state["status"]));
  for (Index j = 0; !course.records.empty() && j < view.space.count(); ++j) {
    body += makeFigure(course, point, view, j);
  }
  body += "<h2>Changes</h2>" + makeAlarmText(makeTrackAlarms(point, 0, view));
  if (state.contains("forecast")) {
    body += "<h2>Forecast</h2><p>When each limit is crossed, with its 95 % interval.</p>" +
            makeTable(state["forecast"], {{"parameter", "parameter"},
                                          {"min", "min"},
                                          {"max", "max"},
                                          {"median", "median"},
                                          {"from", "lower"},
                                          {"to", "upper"}});
  }
  body += "<h2>Last measurements</h2>" + makeLastMeasurements(course);
  return fmt::format(
      "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
      "content='width=device-width'><title>{0}</title><style>{1}</style></head><body><main>{2}</main></body>"
      "</html>\n",
      escapeHtml(name), kStyle, body);
}

}  // namespace twinmap
