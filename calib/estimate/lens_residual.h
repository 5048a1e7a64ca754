#pragma once

#include "calib/geometry/brown_lens.h"

namespace pixelflex::calib {

/// The unknown view and lens of a projector applied to a screen point (x, y and, on a bent screen, z; unit spread):
/// pixels from the frame's middle. h: eight numbers of a homography whose ninth is 1; depth: its column of z. The view
/// maps to pixels over `scale`; the lens works about its own centre. A template for automatic differentiation.
template <class T>
void lensPixel(const T* h, const T* depth, const T* radial, const T* tangential, const T* centre, double scale,
               const T* onScreen, T* pixel) {
  const T w = h[6] * onScreen[0] + h[7] * onScreen[1] + T(1) + depth[2] * onScreen[2];
  const T x = (h[0] * onScreen[0] + h[1] * onScreen[1] + h[2] + depth[0] * onScreen[2]) / w;
  const T y = (h[3] * onScreen[0] + h[4] * onScreen[1] + h[5] + depth[1] * onScreen[2]) / w;
  const T cx = centre[0] / scale;
  const T cy = centre[1] / scale;
  T dx;
  T dy;
  BrownLens::distort(T(x - cx), T(y - cy), radial, tangential, &dx, &dy);
  pixel[0] = (dx + cx) * scale;
  pixel[1] = (dy + cy) * scale;
}

/// Keeps a lens's centre, which is nearly free, from wandering off where nothing holds it (calibration reference 2).
/// `centre`: pixels from the frame's middle.
struct LensCentrePrior {
  static constexpr double kDeviation = 5000;  // projector pixels
  template <class T>
  bool operator()(const T* centre, T* residual) const {
    residual[0] = centre[0] / kDeviation;
    residual[1] = centre[1] / kDeviation;
    return true;
  }
};

}  // namespace pixelflex::calib
