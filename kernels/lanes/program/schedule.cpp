#include "kernels/lanes/program/schedule.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <unordered_map>
#include <utility>

namespace twinmap::program {
namespace {

/// List scheduling with one queue an operation.
class Scheduler {
 public:
  explicit Scheduler(const std::vector<Step>& steps)
      : steps_(steps), users_(steps.size()), missing_(steps.size()) {
    std::unordered_map<int, int> makers;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (const int result : steps[i].results) {
        makers[result] = static_cast<int>(i);
      }
    }
    makers.erase(-1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (const int operand : steps[i].operands) {
        const auto maker = makers.find(operand);
        if (maker != makers.end()) {
          users_[maker->second].push_back(static_cast<int>(i));
          ++missing_[i];
        }
      }
    }
  }

  std::vector<Step> run() {
    calcHeights();
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      makeReadyIfComplete(static_cast<int>(i));
    }
    while (order_.size() < steps_.size()) {
      emptyQueue(findMostUrgentQueue());
    }
    return std::move(order_);
  }

 private:
  using Queue = std::vector<int>;

  void makeReadyIfComplete(int step) {
    if (missing_[step] == 0) {
      ready_[static_cast<int>(steps_[step].operation)].push_back(step);
    }
  }

  /// How many steps follow each on the longest way to an end, itself included.
  void calcHeights() {
    std::vector<int> missing = missing_, order;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (missing[i] == 0) {
        order.push_back(static_cast<int>(i));
      }
    }
    for (std::size_t next = 0; next < order.size(); ++next) {
      for (const int user : users_[order[next]]) {
        if (--missing[user] == 0) {
          order.push_back(user);
        }
      }
    }
    heights_.assign(steps_.size(), 1);
    for (std::size_t i = order.size(); i-- > 0;) {
      for (const int user : users_[order[i]]) {
        heights_[order[i]] = std::max(heights_[order[i]], 1 + heights_[user]);
      }
    }
  }

  Queue& findMostUrgentQueue() {
    const auto calcUrgency = [this](const Queue& queue) {
      int height = 0;
      for (const int step : queue) {
        height = std::max(height, heights_[step]);
      }
      return std::make_pair(height, queue.size());
    };
    const auto most = std::max_element(ready_.begin(), ready_.end(), [&](const Queue& a, const Queue& b) {
      return calcUrgency(a) < calcUrgency(b);
    });
    assert(!most->empty());
    return *most;
  }

  /// Also of what becomes ready on the way.
  void emptyQueue(Queue& queue) {
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const int step = queue[next];
      order_.push_back(steps_[step]);
      for (const int user : users_[step]) {
        --missing_[user];
        makeReadyIfComplete(user);
      }
    }
    queue.clear();
  }

  const std::vector<Step>& steps_;
  std::vector<std::vector<int>> users_;  ///< by step, once for each operand
  std::vector<int> missing_;             ///< operands not yet computed
  std::vector<int> heights_;
  std::array<Queue, static_cast<int>(Operation::kCount)> ready_;
  std::vector<Step> order_;
};

}  // namespace

std::vector<Step> schedule(const std::vector<Step>& steps) {
  std::vector<Step> order;
  for (std::size_t begin = 0; begin < steps.size(); begin += kLargestPiece) {
    const std::size_t end = std::min(steps.size(), begin + kLargestPiece);
    const std::vector<Step> piece(steps.begin() + static_cast<std::ptrdiff_t>(begin),
                                  steps.begin() + static_cast<std::ptrdiff_t>(end));
    const std::vector<Step> ordered = Scheduler(piece).run();
    order.insert(order.end(), ordered.begin(), ordered.end());
  }
  return order;
}

}  // namespace twinmap::program
