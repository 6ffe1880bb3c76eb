// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cairo.h>

#include <memory>
#include <string>

namespace adit {

/// A colour with its opacity; each part in [0, 1].
struct Colour {
  double r, g, b, a{1.0};
};

enum class Align { left, centre, right };

/// A cairo image with the few strokes that pictures need. Pixels, y down. cairo stores errors until
/// save().
class Sketch {
 public:
  Sketch(int width, int height);

  cairo_t* cairo() const { return context_.get(); }
  void fill(double x, double y, double width, double height, Colour colour);
  void rounded(double x, double y, double width, double height, double radius, Colour colour);
  void line(double x0, double y0, double x1, double y1, double thickness, Colour colour);
  void disc(double x, double y, double radius, Colour colour);
  void ring(double x, double y, double radius, double thickness, Colour colour);
  /// `y` is the middle of the letters' height.
  void text(double x, double y, double size, const std::string& text, Colour colour,
            Align align = Align::left, bool bold = false);
  double text_width(double size, const std::string& text, bool bold = false);
  /// Whether the file was written.
  bool save(const std::string& file);
  /// The picture as the content of a PNG file; empty when it could not be drawn.
  std::string png();

 private:
  void font(double size, bool bold);
  void source(Colour colour);

  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace adit
