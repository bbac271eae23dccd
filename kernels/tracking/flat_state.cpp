#include "kernels/tracking/flat_state.hpp"

#include <stdexcept>

namespace twinmap::tracking {
namespace {

class Writer {
 public:
  void operator()(const double& value) { numbers.push_back(value); }
  void operator()(const int& value) { numbers.push_back(value); }
  void operator()(const long long& value) { numbers.push_back(static_cast<double>(value)); }
  template <int rows, int columns>
  void operator()(const Eigen::Matrix<double, rows, columns>& values) {
    numbers.insert(numbers.end(), values.data(), values.data() + values.size());
  }
  template <class T>
  std::size_t count(const std::vector<T>& items) {
    numbers.push_back(static_cast<double>(items.size()));
    return items.size();
  }

  std::vector<double> numbers;
};

class Reader {
 public:
  explicit Reader(const std::vector<double>& numbers) : numbers_(numbers) {}
  void operator()(double& value) { value = next(); }
  void operator()(int& value) { value = static_cast<int>(next()); }
  void operator()(long long& value) { value = static_cast<long long>(next()); }
  template <int rows, int columns>
  void operator()(Eigen::Matrix<double, rows, columns>& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      values.data()[i] = next();
    }
  }
  template <class T>
  std::size_t count(std::vector<T>& items) {
    const double size = next();
    if (!(size >= 0.0 && size <= static_cast<double>(numbers_.size()))) {
      refuse();
    }
    items.resize(static_cast<std::size_t>(size));
    return items.size();
  }
  void finish() const {
    if (place_ != numbers_.size()) {
      refuse();
    }
  }

 private:
  [[noreturn]] static void refuse() {
    throw std::runtime_error("the numbers of the state are not those of such a tracker");
  }
  double next() {
    if (place_ == numbers_.size()) {
      refuse();
    }
    return numbers_[place_++];
  }

  const std::vector<double>& numbers_;
  std::size_t place_ = 0;
};

/// Each number of a state in its order; vectors of a reader have their sizes before.
template <class Archive, class State>
void visit(Archive& archive, const Model& sizes, State& state) {
  archive(state.count), archive(state.informed), archive(state.time), archive(state.interval),
      archive(state.variances);
  archive(state.reference), archive(state.spread), archive(state.condition_counts);
  archive(state.belief.mean), archive(state.belief.covariance);
  archive(state.run_of_bad), archive(state.surprises), archive(state.widening);
  for (auto& filters : state.filters) {
    archive(filters.log_weights);
    for (auto& belief : filters.beliefs) {
      archive(belief.mean), archive(belief.covariance);
    }
  }
  archive.count(state.changes.changes);
  for (auto& change : state.changes.changes) {
    if constexpr (!std::is_const_v<State>) {
      change.signature.resize(sizes.countStates());
    }
    double parameter = static_cast<double>(change.parameter);
    archive(parameter);
    if constexpr (!std::is_const_v<State>) {
      change.parameter = static_cast<Eigen::Index>(parameter);
    }
    archive(change.time), archive(change.signature), archive(change.size), archive(change.variance);
    archive(change.log_ratio);
  }
  archive.count(state.changes.log_weights);
  for (auto& weights : state.changes.log_weights) {
    if constexpr (!std::is_const_v<State>) {
      weights.resize(kRates, static_cast<Eigen::Index>(state.filters.size()));
    }
    archive(weights);
  }
}

}  // namespace

std::vector<double> flatten(const TrackerState& state) {
  Writer writer;
  visit(writer, Model{}, state);
  return std::move(writer.numbers);
}

TrackerState unflatten(const Model& model, const std::vector<double>& numbers) {
  TrackerState state = Tracker(model).getState();
  Reader reader(numbers);
  visit(reader, model, state);
  reader.finish();
  for (const Supposed& change : state.changes.changes) {
    if (change.parameter < 0 || change.parameter >= model.countParameters()) {
      throw std::runtime_error("the state supposes a change of a parameter that there is not");
    }
  }
  return state;
}

}  // namespace twinmap::tracking
