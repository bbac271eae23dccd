#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "framework/base/json/json.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/serve/live/measurement_service.hpp"

namespace twinmap::serve {

/// A twin of one parameter that counts. A text with "bad" in it cannot be used, "broken" cannot be worked on.
class FakeService : public MeasurementService {
 public:
  std::chrono::milliseconds duration{0};         // of an answer
  std::chrono::milliseconds commit_duration{0};  // and of a commit
  std::atomic<bool> disk_is_full{false};
  std::atomic<int> answered{0}, committed{0}, commits{0};

  Json answer(const PostedMeasurement& posted) override {
    std::this_thread::sleep_for(duration);
    if (posted.text.find("bad") != std::string::npos) {
      throw ExperimentError(posted.name + ":1: 'bad' must be a number");
    }
    if (posted.text.find("broken") != std::string::npos) {
      throw std::runtime_error("the simulator broke");
    }
    ++answered;
    return {{"source", posted.name},
            {"status", "ok"},
            {"text", posted.text.size() > 100 ? "long" : posted.text},
            {"size", posted.text.size()},
            {"at", posted.at},
            {"trial", posted.trial},
            {"track", {{"measurements", answered.load()}}}};
  }

  void commit() override {
    std::this_thread::sleep_for(commit_duration);
    if (disk_is_full) {
      throw std::runtime_error("track.h5: cannot be written: No space left on device");
    }
    committed = answered.load();
    ++commits;
  }

  Json getState() const override {
    const double sd = 1.0 / std::sqrt(1.0 + answered);
    Json state{
        {"measurements", answered.load()},
        {"parameters",
         {{"k \"0\"",
           {{"mean", 95.0}, {"sd", sd}, {"lower", 95 - 2 * sd}, {"upper", 95 + 2 * sd}, {"unit", "N/m"}}}}},
        {"alarms", Json::array()}};
    if (answered >= 3) {
      state["alarms"].push_back("k: a step of 3 at measurement 3");
    }
    return state;
  }

  std::string makeHistory(std::size_t most) const override {
    std::string text = "time,source,status,used,parameter,unit,mean,sd,lower,upper,smoothed_mean\n";
    const int first = std::max(1, answered - static_cast<int>(most) + 1);
    for (int i = first; i <= answered; ++i) {
      text += std::to_string(i) + ",\"a, b.csv\",ok,1,k,N/m," + std::to_string(95 + std::sin(i)) +
              ",1,93,97,95\n";
    }
    return text;
  }

  std::string makePage() const override { return "<!DOCTYPE html><title>whole</title>"; }
};

}  // namespace twinmap::serve
