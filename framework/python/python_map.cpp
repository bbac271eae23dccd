#include "framework/python/python_map.hpp"

namespace twinmap::python {

PythonMap::Session PythonMap::borrow(Refine refine) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Session>& idle = idle_[refine];
    if (!idle.empty()) {
      Session session = std::move(idle.back());
      idle.pop_back();
      return session;
    }
  }
  return std::make_unique<MeasurementSession>(inferrer_, refine);
}

void PythonMap::giveBack(Refine refine, Session session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_[refine].push_back(std::move(session));
}

}  // namespace twinmap::python
