#include "framework/python/python_map.hpp"

namespace twinmap::python {

PythonMap::Session PythonMap::borrow(const Manner& manner) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Session>& idle = idle_[manner];
    if (!idle.empty()) {
      Session session = std::move(idle.back());
      idle.pop_back();
      return session;
    }
  }
  return std::make_unique<MeasurementSession>(inferrer_, manner.first, manner.second);
}

void PythonMap::giveBack(const Manner& manner, Session session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_[manner].push_back(std::move(session));
}

}  // namespace twinmap::python
