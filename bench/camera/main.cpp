// SPDX-License-Identifier: Apache-2.0
// bench_camera: pictures of a camera on each rung of the ladder: bytes, quality, time, and what is marked
// when pieces are lost.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "bench/camera/frames.hpp"
#include "perception/camera/ladder.hpp"
#include "perception/camera/stripe_encoder.hpp"
#include "perception/camera/stripe_store.hpp"

namespace {

using namespace adit;
using namespace adit::perception;

struct Options {
  std::string folder{};
  std::size_t frames{40};
  std::uint32_t shift{6};
  double rate{10.0};  // Pictures/s of the frames.
  std::size_t piece{1200};
  std::size_t stripe{400};
  double loss{0.1};
};

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double squares(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.bytes.size(), b.bytes.size()); ++i) {
    const int d = a.bytes[i] - b.bytes[i];
    sum += d * d;
  }
  return sum / static_cast<double>(a.bytes.size());
}

std::size_t ones(const std::vector<std::uint8_t>& bits) {
  std::size_t count = 0;
  for (const std::uint8_t byte : bits) count += static_cast<std::size_t>(std::popcount(byte));
  return count;
}

struct Row {
  double bytes{}, pieces{}, squares{}, convert_ms{}, encode_ms{}, decode_ms{}, marked{}, span{};
  std::uint32_t width{}, height{}, formats{};
};

/// @param whole All stripes of each picture are sent; else those that changed.
Row run_rung(const std::vector<Picture>& frames, const Rung& rung, const Options& options, bool whole) {
  StripeEncoder encoder;
  StripeStore full, lossy;
  std::minstd_rand random(1);
  Row row;
  PictureFormat last{};
  Time now{}, reported{};
  for (std::uint32_t frame = 1; frame <= frames.size(); ++frame) {
    const Picture& source = frames[frame - 1];
    const RawPicture raw{source.width, source.height, 3 * source.width, "rgb8", false, source.bytes};
    auto start = std::chrono::steady_clock::now();
    const auto scaled = convert(raw, rung.width, rung.height);
    row.convert_ms += ms_since(start);
    const PictureFormat wanted{static_cast<std::uint16_t>(scaled->width),
                               static_cast<std::uint16_t>(scaled->height), rung.colour, rung.quality, 0};
    now += from_seconds(1.0 / options.rate);
    if (whole) encoder.reset();
    start = std::chrono::steady_clock::now();
    const auto coded = encoder.encode(*scaled, wanted, options.stripe, now);
    row.encode_ms += ms_since(start);
    if (coded.format != last) ++row.formats;
    last = coded.format;
    PictureHeader header;
    header.run = 1;
    header.frame = frame;
    header.format = coded.format;
    header.digest = coded.digest;
    header.pose = CameraPose{{}, {0, 0, 0, 1}};
    const auto pieces = cut(header, coded.stripes, options.piece);
    for (const PicturePiece& piece : pieces) {
      row.bytes += static_cast<double>(encode(piece).size());
      full.take(piece);
      if (static_cast<double>(random() % 10'000) >= options.loss * 10'000) lossy.take(piece);
    }
    row.pieces += static_cast<double>(pieces.size());
    start = std::chrono::steady_clock::now();
    const auto shown = decode_jpeg_tolerant(full.as_jpeg(), 4000, 4000);
    row.decode_ms += ms_since(start);
    Picture reference = *scaled;
    if (!rung.colour) {
      for (std::size_t i = 0; i < shown->bytes.size(); ++i)
        reference.bytes[i] = static_cast<std::uint8_t>(
            (77 * scaled->bytes[3 * i] + 150 * scaled->bytes[3 * i + 1] + 29 * scaled->bytes[3 * i + 2]) >>
            8);
      reference.bytes.resize(shown->bytes.size());
    }
    row.squares += squares(reference, *shown);
    // The receiver reports once a second what it lacks.
    row.marked += lossy.newest() ? static_cast<double>(ones(lossy.missing())) / coded.format.stripes() : 1.0;
    if (now - reported >= 1s) {
      reported = now;
      encoder.missing(lossy.missing(false));
    }
    row.span += coded.format.span;
    row.width = scaled->width;
    row.height = scaled->height;
  }
  const auto count = static_cast<double>(frames.size());
  for (double* mean : {&row.bytes, &row.pieces, &row.squares, &row.convert_ms, &row.encode_ms, &row.decode_ms,
                       &row.marked, &row.span})
    *mean /= count;
  return row;
}

void print_rungs(const std::vector<Picture>& frames, const Options& options) {
  fmt::print("{:>14} {:>3} {:>5} {:>9} {:>9} {:>9} {:>11} {:>6} {:>5} {:>7} {:>7} {:>7} {:>8}\n", "rung", "q",
             "color", "size", "whole B", "sent B", "B/s", "PSNR", "span", "scale", "encode", "decode",
             "marked");
  for (const Rung& rung : rungs()) {
    const Row whole = run_rung(frames, rung, options, true), sent = run_rung(frames, rung, options, false);
    const double low = whole.bytes * rung.least_rate, high = whole.bytes * rung.most_rate;
    fmt::print(
        "{:>14} {:>3} {:>5} {:>9} {:>9.0f} {:>9.0f} {:>11} {:>6.1f} {:>5.1f} {:>4.1f} ms {:>4.1f} ms "
        "{:>4.1f} ms"
        " {:>6.1f} %\n",
        fmt::format("{}x{}", rung.width, rung.height), rung.quality, rung.colour ? "yes" : "no",
        fmt::format("{}x{}", sent.width, sent.height), whole.bytes, sent.bytes,
        fmt::format("{:.1f}-{:.1f}k", low / 1000, high / 1000),
        10.0 * std::log10(255.0 * 255.0 / sent.squares), sent.span, sent.convert_ms, sent.encode_ms,
        sent.decode_ms, 100.0 * sent.marked);
  }
}

/// What the ladder makes of links of the design.
void print_links(const std::vector<Picture>& frames, const Options& options) {
  for (const double kbits : {10.0, 30.0, 150.0, 1000.0, 6000.0, 20'000.0}) {
    Ladder ladder;
    Time now{};
    const LadderInput input{kbits * 125.0, 2000, 30.0};
    double bytes = 0.0;
    int pictures = 0, changes = 0;
    Ladder::Choice choice{};
    std::size_t next = 0;
    StripeEncoder encoder;
    while (now < Time{} + 20s) {
      const auto chosen = ladder.choose(input, now);
      if (!(chosen.rung == choice.rung)) ++changes;
      choice = chosen;
      const Picture& source = frames[next % frames.size()];
      next += std::max<std::size_t>(1, static_cast<std::size_t>(seconds(choice.period) * options.rate));
      const auto scaled =
          convert({source.width, source.height, 3 * source.width, "rgb8", false, source.bytes},
                  choice.rung.width, choice.rung.height);
      const auto coded = encoder.encode(
          *scaled,
          {static_cast<std::uint16_t>(scaled->width), static_cast<std::uint16_t>(scaled->height),
           choice.rung.colour, choice.rung.quality, 0},
          options.stripe, now);
      PictureHeader header;
      header.run = header.frame = 1;
      header.format = coded.format;
      header.pose = CameraPose{};
      std::size_t size = 0;
      for (const PicturePiece& piece : cut(header, coded.stripes, options.piece))
        size += encode(piece).size();
      ladder.coded(choice.rung, size, coded.whole);
      bytes += static_cast<double>(size);
      ++pictures;
      now += choice.period;
    }
    const double time = seconds(now.time_since_epoch());
    fmt::print("{:>7.0f} kbit/s: {}x{} q{} {}, {:.1f} pictures/s, {:.0f} kbit/s, {} changes of the rung\n",
               kbits, choice.rung.width, choice.rung.height, choice.rung.quality,
               choice.rung.colour ? "colour" : "grey", pictures / time, bytes * 0.008 / time, changes - 1);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Pictures of a camera on the rungs of the ladder"};
  app.add_option("folder", options.folder, "JPEG or PPM pictures; without it, made-up ones");
  app.add_option("--frames", options.frames, "Pictures, at most");
  app.add_option("--shift", options.shift, "Motion of the made-up pictures, pixels a picture");
  app.add_option("--rate", options.rate, "Pictures/s of the source");
  app.add_option("--piece", options.piece, "Bytes of a piece");
  app.add_option("--stripe", options.stripe, "Largest stripe, bytes");
  app.add_option("--loss", options.loss, "Part of the pieces that is lost");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto frames = options.folder.empty() ? bench::made_up_frames(options.frames, options.shift)
                                               : bench::frames_of(options.folder, options.frames);
    fmt::print(
        "{} pictures of {} x {}, pieces of {} B, stripes of at most {} B, {:.0f} % of the pieces lost\n",
        frames.size(), frames[0].width, frames[0].height, options.piece, options.stripe, 100 * options.loss);
    print_rungs(frames, options);
    print_links(frames, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_camera: %s\n", error.what());
    return 1;
  }
  return 0;
}
