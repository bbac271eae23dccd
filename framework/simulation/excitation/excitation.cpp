#include "framework/simulation/excitation/excitation.hpp"

#include <algorithm>
#include <cmath>

#include "framework/simulation/excitation/excitation_terms.hpp"

namespace twinmap {
namespace {

constexpr double kTwoPi = 6.283185307179586;

struct ShapeAt {
  double elapsed;  ///< time since the term's begin, s

  double operator()(const LineShape& line) const { return line.value + line.slope * elapsed; }

  double operator()(const ToneShape& shape) const {
    double sum = 0.0;
    for (const ToneShape::Tone& tone : shape.tones) {
      sum += tone.weight * std::sin(tone.omega * elapsed + tone.phase);
    }
    return shape.amplitude * sum;
  }

  double operator()(const ChirpShape& chirp) const {
    const double cycles = chirp.logarithmic
                              ? chirp.start_frequency * std::expm1(chirp.rate * elapsed) / chirp.rate
                              : elapsed * (chirp.start_frequency + 0.5 * chirp.rate * elapsed);
    return chirp.amplitude * std::sin(kTwoPi * cycles);
  }

  double operator()(const SplineShape& shape) const { return shape.spline->calc(elapsed); }
};

void checkTables(const SignalSpec& signal) {
  for (const TableSpec& table : signal.tables) {
    if (table.times.size() != table.values.size() || table.times.size() < 2) {
      throw ExperimentError(signal.name.where, signal.name.text,
                            "has a table whose times and values are not two or more pairs");
    }
    if (!std::is_sorted(table.times.begin(), table.times.end())) {
      throw ExperimentError(signal.name.where, signal.name.text, "has a table whose times decrease");
    }
    const bool repeats = std::adjacent_find(table.times.begin(), table.times.end()) != table.times.end();
    if (repeats && table.interpolation == TableInterpolation::kCubic) {
      throw ExperimentError(signal.name.where, signal.name.text, "has a cubic table with a time given twice");
    }
  }
}

void checkPhases(const SignalSpec& signal) {
  for (const MultisineSpec& multisine : signal.multisines) {
    if (!multisine.phases.empty() && multisine.phases.size() != multisine.frequencies.size()) {
      throw ExperimentError(signal.name.where, signal.name.text,
                            "has a multisine with a number of phases that differs from its frequencies");
    }
  }
}

}  // namespace

Excitation::Excitation(const std::vector<SignalSpec>& signals) : signals_(signals) {
  for (const SignalSpec& signal : signals) {
    checkTables(signal);
    checkPhases(signal);
    for (const TableSpec& table : signal.tables) {
      if (table.interpolation == TableInterpolation::kCubic) {
        splines_.try_emplace(&table, table.times, table.values);
      }
    }
  }
}

void Excitation::update(NumberEvaluator& numbers) {
  mute();
  terms_.clear();
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    appendTerms(signals_[i], static_cast<int>(i), splines_, numbers, terms_);
  }
  std::stable_sort(terms_.begin(), terms_.end(),
                   [](const ExcitationTerm& a, const ExcitationTerm& b) { return a.begin < b.begin; });
}

std::vector<double> Excitation::calcEventTimes(double duration) const {
  std::vector<double> times;
  for (const ExcitationTerm& term : terms_) {
    for (const double t : {term.begin, term.end}) {
      if (t > 0.0 && t < duration) {
        times.push_back(t);
      }
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

void Excitation::beginPhase(double begin) {
  for (; next_ < terms_.size() && terms_[next_].begin <= begin; ++next_) {
    active_.push_back(&terms_[next_]);
  }
  const auto over = [begin](const ExcitationTerm* term) { return term->end <= begin; };
  active_.erase(std::remove_if(active_.begin(), active_.end(), over), active_.end());
}

void Excitation::mute() {
  active_.clear();
  next_ = 0;
}

void Excitation::calcValues(double t, std::vector<double>& values) const {
  std::fill(values.begin(), values.end(), 0.0);
  for (const ExcitationTerm* term : active_) {
    values[term->signal] += calcTerm(*term, t);
  }
}

double calcTerm(const ExcitationTerm& term, double t) {
  return std::visit(ShapeAt{t - term.begin}, term.shape);
}

}  // namespace twinmap
