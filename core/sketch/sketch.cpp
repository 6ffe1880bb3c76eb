// SPDX-License-Identifier: Apache-2.0
#include "core/sketch/sketch.hpp"

#include <cmath>

namespace adit {

Sketch::Sketch(int width, int height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      context_(cairo_create(surface_.get()), cairo_destroy) {
  cairo_set_line_cap(cairo(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo(), CAIRO_LINE_JOIN_ROUND);
}

void Sketch::source(Colour colour) { cairo_set_source_rgba(cairo(), colour.r, colour.g, colour.b, colour.a); }

void Sketch::fill(double x, double y, double width, double height, Colour colour) {
  source(colour);
  cairo_rectangle(cairo(), x, y, width, height);
  cairo_fill(cairo());
}

void Sketch::rounded(double x, double y, double width, double height, double radius, Colour colour) {
  source(colour);
  cairo_new_sub_path(cairo());
  cairo_arc(cairo(), x + width - radius, y + radius, radius, -M_PI / 2, 0.0);
  cairo_arc(cairo(), x + width - radius, y + height - radius, radius, 0.0, M_PI / 2);
  cairo_arc(cairo(), x + radius, y + height - radius, radius, M_PI / 2, M_PI);
  cairo_arc(cairo(), x + radius, y + radius, radius, M_PI, 1.5 * M_PI);
  cairo_close_path(cairo());
  cairo_fill(cairo());
}

void Sketch::line(double x0, double y0, double x1, double y1, double thickness, Colour colour) {
  source(colour);
  cairo_set_line_width(cairo(), thickness);
  cairo_move_to(cairo(), x0, y0);
  cairo_line_to(cairo(), x1, y1);
  cairo_stroke(cairo());
}

void Sketch::disc(double x, double y, double radius, Colour colour) {
  source(colour);
  cairo_new_sub_path(cairo());
  cairo_arc(cairo(), x, y, radius, 0.0, 2 * M_PI);
  cairo_fill(cairo());
}

void Sketch::ring(double x, double y, double radius, double thickness, Colour colour) {
  source(colour);
  cairo_set_line_width(cairo(), thickness);
  cairo_new_sub_path(cairo());
  cairo_arc(cairo(), x, y, radius, 0.0, 2 * M_PI);
  cairo_stroke(cairo());
}

void Sketch::font(double size, bool bold) {
  cairo_select_font_face(cairo(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo(), size);
}

double Sketch::text_width(double size, const std::string& text, bool bold) {
  font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo(), text.c_str(), &extents);
  return extents.x_advance;
}

void Sketch::text(double x, double y, double size, const std::string& text, Colour colour, Align align,
                  bool bold) {
  const double width = text_width(size, text, bold);
  source(colour);
  cairo_move_to(cairo(),
                align == Align::left    ? x
                : align == Align::right ? x - width
                                        : x - 0.5 * width,
                y + 0.35 * size);
  cairo_show_text(cairo(), text.c_str());
  cairo_new_path(cairo());
}

bool Sketch::save(const std::string& file) {
  cairo_surface_flush(surface_.get());
  return cairo_status(cairo()) == CAIRO_STATUS_SUCCESS &&
         cairo_surface_write_to_png(surface_.get(), file.c_str()) == CAIRO_STATUS_SUCCESS;
}

std::string Sketch::png() {
  std::string out;
  const auto add = [](void* to, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_flush(surface_.get());
  const bool drawn = cairo_status(cairo()) == CAIRO_STATUS_SUCCESS &&
                     cairo_surface_write_to_png_stream(surface_.get(), add, &out) == CAIRO_STATUS_SUCCESS;
  return drawn ? out : std::string();
}

}  // namespace adit
