#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace twinmap {

/// Owns an HDF5 identifier and the function that closes it.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
    if (id < 0) {
      throw std::runtime_error(what);
    }
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }

  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

inline void requireHdf5(herr_t status, const std::string& what) {
  if (status < 0) {
    throw std::runtime_error(what);
  }
}

}  // namespace twinmap
