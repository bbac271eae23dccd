#include "framework/base/log/search_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

namespace twinmap {
namespace {

/// As the log, one of the process.
struct Board {
  std::mutex mutex;
  std::thread::id owner;
  SearchState state;
  std::vector<std::string> names;
  std::atomic<long> simulations{0};

  /// With the mutex held.
  bool isOwn() const { return !state.stages.empty() && owner == std::this_thread::get_id(); }
  bool takesBest() const {
    return isOwn() && std::none_of(state.stages.begin(), state.stages.end(),
                                   [](const SearchState::Stage& stage) { return stage.supposes; });
  }
};

Board& getBoard() {
  static Board board;
  return board;
}

}  // namespace

std::string describeDuration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  constexpr long kMinute = 60, kHour = 3600;
  const std::string minutes = fmt::format("{}:{:02}", whole / kMinute, whole % kMinute);
  return whole < kHour
             ? minutes
             : fmt::format("{}:{:02}:{:02}", whole / kHour, whole % kHour / kMinute, whole % kMinute);
}

SearchState getSearchState() {
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  SearchState state = board.state;
  state.simulations = board.simulations;
  return state;
}

std::string describeState(const SearchState& state) {
  std::vector<std::string> phrases;
  for (const SearchState::Stage& stage : state.stages) {
    phrases.push_back(stage.total > 0 ? fmt::format("{}, {} of {}", stage.name, stage.done, stage.total)
                                      : stage.name);
  }
  std::string text = fmt::format("{}", fmt::join(phrases, ": "));
  if (state.best) {
    text += fmt::format("{}chi-square {:.4g} of {:.0f} at best", text.empty() ? "" : ", ",
                        state.best->chi_square, state.best->degrees);
  }
  if (state.simulations > 0) {
    text += fmt::format("{}{} simulations", text.empty() ? "" : ", ", state.simulations);
  }
  return text;
}

std::string describeBest(const SearchState& state) {
  if (!state.best) {
    return "";
  }
  std::vector<std::string> phrases;
  for (std::size_t i = 0; i < state.best->names.size(); ++i) {
    phrases.push_back(fmt::format("{} = {:.4g}", state.best->names[i], state.best->values[i]));
    if (i < state.best->stddevs.size()) {
      phrases.back() += fmt::format(" (sd {:.2g})", state.best->stddevs[i]);
    }
  }
  return fmt::format("{}", fmt::join(phrases, ", "));
}

SearchStage::SearchStage(std::string name, int total) : SearchStage(std::move(name), total, false) {}

SearchStage SearchStage::supposing(std::string name) {
  return SearchStage(std::move(name), 0, true);
}

SearchStage::SearchStage(std::string name, int total, bool supposes) {
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  if (board.state.stages.empty()) {
    board.owner = std::this_thread::get_id();
    board.state.best.reset();
    board.simulations = 0;
  } else if (!board.isOwn()) {
    return;
  }
  board.state.stages.push_back({std::move(name), 0, total, supposes});
  depth_ = board.state.stages.size();
}

SearchStage::~SearchStage() {
  if (depth_ == 0) {
    return;
  }
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  board.state.stages.resize(depth_ - 1);
}

void SearchStage::show(int done, int total) {
  if (depth_ == 0) {
    return;
  }
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  SearchState::Stage& stage = board.state.stages[depth_ - 1];
  stage.done = done;
  stage.total = total;
}

void SearchStage::advance() {
  if (depth_ == 0) {
    return;
  }
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  ++board.state.stages[depth_ - 1].done;
}

void beginBest(std::vector<std::string> names) {
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  if (board.takesBest()) {
    board.state.best.reset();
    board.names = std::move(names);
  }
}

void noteBest(double chi_square, double degrees, std::vector<double> values) {
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  const std::optional<BestFit>& best = board.state.best;
  if (board.takesBest() && values.size() == board.names.size() && (!best || chi_square < best->chi_square)) {
    std::vector<double> stddevs = best ? best->stddevs : std::vector<double>();
    board.state.best = {chi_square, degrees, board.names, std::move(values), std::move(stddevs)};
  }
}

void noteStddevs(std::vector<double> stddevs) {
  Board& board = getBoard();
  const std::lock_guard lock(board.mutex);
  if (board.takesBest() && board.state.best) {
    board.state.best->stddevs = std::move(stddevs);
  }
}

void noteSimulations(long count) {
  getBoard().simulations += count;
}

}  // namespace twinmap
