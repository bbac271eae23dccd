#include "framework/data/measurement/files/time_stamp.hpp"

#include <cstdint>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

/// Takes what a stamp consists of from the front of a text.
class StampReader {
 public:
  explicit StampReader(std::string_view text) : rest_(text) {}

  bool isDone() const { return ok_ && rest_.empty(); }

  /// A number of that many digits, within its limits.
  int takeNumber(int digits, int least, int most) {
    int number = 0;
    for (int i = 0; i < digits; ++i) {
      const char c = takeAny();
      ok_ = ok_ && c >= '0' && c <= '9';
      number = 10 * number + (c - '0');
    }
    ok_ = ok_ && number >= least && number <= most;
    return number;
  }

  void require(std::string_view characters) { ok_ = takeIf(characters) != 0 && ok_; }

  /// The next character if it is one of these, else 0.
  char takeIf(std::string_view characters) {
    const bool found = !rest_.empty() && characters.find(rest_.front()) != std::string_view::npos;
    return found ? takeAny() : 0;
  }

  double takeFraction() {
    double fraction = 0.0, place = 0.1;
    for (char c = takeIf(kDigits); c != 0; c = takeIf(kDigits)) {
      fraction += place * (c - '0');
      place *= 0.1;
    }
    return fraction;
  }

 private:
  static constexpr std::string_view kDigits = "0123456789";

  char takeAny() {
    const char c = rest_.empty() ? 0 : rest_.front();
    rest_.remove_prefix(rest_.empty() ? 0 : 1);
    return c;
  }

  std::string_view rest_;
  bool ok_ = true;
};

/// Days since 1970-01-01 in the Gregorian calendar: years that begin in March end in the leap day.
std::int64_t countDays(int year, int month, int day) {
  const std::int64_t y = month > 2 ? year : year - 1;
  const std::int64_t in_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return 365 * y + y / 4 - y / 100 + y / 400 + in_year - 719468;
}

/// The zone's offset, s.
int takeZone(StampReader& reader) {
  const char sign = reader.takeIf("Z+-");
  if (sign == 0 || sign == 'Z') {
    return 0;
  }
  const int hours = reader.takeNumber(2, 0, 14);
  reader.takeIf(":");
  const int offset = 3600 * hours + 60 * reader.takeNumber(2, 0, 59);
  return sign == '-' ? -offset : offset;
}

}  // namespace

bool parseTimeStamp(std::string_view text, double& seconds) {
  StampReader reader(text);
  const int year = reader.takeNumber(4, 1600, 9999);
  reader.require("-/");
  const int month = reader.takeNumber(2, 1, 12);
  reader.require("-/");
  const int day = reader.takeNumber(2, 1, 31);
  reader.require("T ");
  const int hour = reader.takeNumber(2, 0, 23);
  reader.require(":");
  const int minute = reader.takeNumber(2, 0, 59);
  int second = 0;
  double fraction = 0.0;
  if (reader.takeIf(":") != 0) {
    second = reader.takeNumber(2, 0, 60);
    fraction = reader.takeIf(".,") != 0 ? reader.takeFraction() : 0.0;
  }
  const int zone = takeZone(reader);
  if (!reader.isDone()) {
    return false;
  }
  const std::int64_t whole = 86400 * countDays(year, month, day) + 3600 * hour + 60 * minute + second - zone;
  seconds = static_cast<double>(whole) + fraction;
  return true;
}

bool parseTime(const std::string& text, double& seconds) {
  return parseTimeStamp(text, seconds) || parseLiteral(text, seconds);
}

}  // namespace twinmap
