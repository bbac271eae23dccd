#include "framework/simulation/excitation/excitation.hpp"

#include <algorithm>
#include <limits>

namespace twinmap {
namespace {

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

/// Evaluates the terms of a signal at a parameter set. A table is one line an interval, a cubic one its
/// spline; both begin earlier by the delay of its clock.
class TermWriter {
 public:
  TermWriter(const SignalSpec& spec, int signal, ModelNumbers& numbers, std::vector<ExcitationTerm>& terms)
      : shapes_(spec, numbers), signal_(signal), terms_(terms) {}

  template <class Term>
  void add(const Term& term) {
    const double begin = shapes_.calcTime(term.start, "start");
    const double end = calcEnd(term.end, begin);
    terms_.push_back({signal_, begin, end, shapes_.make(term)});
  }

  void addTable(const TableSpec& table, const TableSplines& splines) {
    const Expression* delay = table.findDelay();
    const double zero = delay != nullptr ? -shapes_.calcTime(*delay, "delay") : 0.0;
    if (table.interpolation == TableInterpolation::kCubic) {
      terms_.push_back(
          {signal_, zero + table.times.front(), zero + table.times.back(), SplineShape{&splines.at(&table)}});
      return;
    }
    for (const TablePiece& piece : calcTablePieces(table)) {
      terms_.push_back(
          {signal_, zero + piece.begin, zero + piece.end, LineShape{piece.values[0], piece.values[1]}});
    }
  }

 private:
  double calcEnd(const Expression& expression, double start) {
    if (expression.text.empty()) {
      return std::numeric_limits<double>::infinity();
    }
    const double end = shapes_.calcTime(expression, "end");
    if (end <= start) {
      throwUnusable({shapes_.getOwner(), "end", "s"}, end, "must be after its start", expression.where);
    }
    return end;
  }

  ShapeMaker<double, ModelNumbers> shapes_;
  int signal_;
  std::vector<ExcitationTerm>& terms_;
};

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

void Excitation::update(ModelNumbers& numbers) {
  mute();
  terms_.clear();
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    TermWriter writer(signals_[i], static_cast<int>(i), numbers, terms_);
    visitTerms(signals_[i], [&writer](const auto& term) { writer.add(term); });
    for (const TableSpec& table : signals_[i].tables) {
      writer.addTable(table, splines_);
    }
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

void Excitation::calcRates(double t, std::vector<double>& rates) const {
  std::fill(rates.begin(), rates.end(), 0.0);
  const std::size_t count = signals_.size();
  for (const ExcitationTerm* term : active_) {
    std::visit(
        [&, elapsed = t - term->begin](const auto& shape) {
          rates[term->signal] += shape.calcRate(elapsed);
          if (rates.size() > count) {
            rates[count + term->signal] += shape.calcSecondRate(elapsed);
          }
        },
        term->shape);
  }
}

double calcTerm(const ExcitationTerm& term, double t) {
  return std::visit([elapsed = t - term.begin](const auto& shape) { return shape.calc(elapsed); },
                    term.shape);
}

}  // namespace twinmap
