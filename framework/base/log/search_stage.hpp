#pragma once

#include <optional>
#include <string>
#include <vector>

namespace twinmap {

/// The best fit that a search has come to.
struct BestFit {
  double chi_square = 0.0, degrees = 0.0;
  std::vector<std::string> names;  ///< of the unknown parameters
  std::vector<double> values;      ///< in their units
  std::vector<double> stddevs{};   ///< of the first of them; empty before a posterior was drawn from
};

/// What a command that takes minutes is at, for its line of progress and for an interrupt.
struct SearchState {
  struct Stage {
    std::string name;
    int done = 0, total = 0;  ///< parts of it; total: 0: not in parts
    bool supposes = false;    ///< that the recording is another than it was said to be
  };
  std::vector<Stage> stages;  ///< the outermost first
  long simulations = 0;       ///< since the first stage began
  std::optional<BestFit> best;
};

/// From any thread.
SearchState getSearchState();

/// "fit candidates, 2 of 6, chi-square 512 of 396 at best, 3400 simulations"; "" where nothing is known yet.
std::string describeState(const SearchState& state);
/// "0:42", "1:02:03".
std::string describeDuration(double seconds);

/// Of the best fit "k = 14.2, m = 3.01", or with standard deviations "k = 14.2 (sd 0.3), m = 3.01 (sd 0.02)";
/// "" of none.
std::string describeBest(const SearchState& state);

/// Names what the calling thread is at, in SearchState, as long as it lives. Stages of other threads than
/// that of the outermost stage, which work on its parts, are not told of.
class SearchStage {
 public:
  explicit SearchStage(std::string name, int total = 0);
  /// Supposes what was not stated, another noise or clock. Its chi-square does not compare with the stated
  /// one's: within it the best fit stays what it was.
  static SearchStage supposing(std::string name);
  SearchStage(const SearchStage&) = delete;
  SearchStage& operator=(const SearchStage&) = delete;
  ~SearchStage();

  /// done, total: parts of this stage.
  void show(int done, int total);
  /// One part more is done.
  void advance();

 private:
  SearchStage(std::string name, int total, bool supposes);

  std::size_t depth_ = 0;  // 0: not told of
};

/// A search for another best fit begins, over parameters of these names: what is known of an earlier one is
/// forgotten. By the thread of the stages, as noteBest(); others' are left out.
void beginBest(std::vector<std::string> names);
/// Kept where it is the best since beginBest().
void noteBest(double chi_square, double degrees, std::vector<double> values);

/// Of the posterior about the best fit, its first parameters.
void noteStddevs(std::vector<double> stddevs);

/// From any thread.
void noteSimulations(long count);

}  // namespace twinmap
