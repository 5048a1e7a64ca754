#pragma once

#include <stdexcept>

namespace pixelflex::calib {

/// A step cannot be done; what() says which, why and what to do.
class ProcedureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pixelflex::calib
