// SPDX-License-Identifier: Apache-2.0
// Program `recording`: inspects MCAP recordings and recovers the content of truncated ones.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "core/config/usage.hpp"
#include "core/record/idl_value.hpp"
#include "core/record/mcap_reader.hpp"
#include "core/record/mcap_writer.hpp"

namespace {

using namespace adit;
using namespace adit::record;

constexpr const char* kFooter = R"(Examples:
  recording info r1-000012.mcap              what is in it, and how well it can be read
  recording cat run.mcap --topic command     one line a message: time, topic, contents
  recording recover torn.mcap saved.mcap     all that can be read, as a whole file
  recording recover r1-0*.mcap minutes.mcap  several in their order, as one

Exit status: 0 done, 1 the recording is torn or damaged (what could be read was told), 2 it cannot be read or
written, or wrong usage.)";

constexpr int kDamaged = 1;
constexpr int kUnreadable = 2;

int report_error(const std::string& text) {
  std::fprintf(stderr, "recording: %s\n", text.c_str());
  return kUnreadable;
}

Result<ReadReport> read_file(const std::string& file, const Visitor& visitor) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return Error{Reason::cannot_read, "cannot read " + file};
  auto report = read_mcap(in, visitor);
  if (!report) return Error{report.reason(), file + ": " + report.error().text};
  return report;
}

int judged(const std::string& file, const ReadReport& report) {
  if (report.complete) return 0;
  std::fprintf(stderr, "recording: %s: %s; %llu messages could be read\n", file.c_str(),
               report.trouble.empty() ? "it has no end" : report.trouble.c_str(),
               static_cast<unsigned long long>(report.messages));
  return kDamaged;
}

double in_seconds(std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; }

int info(const std::string& file) {
  struct Row {
    Channel channel{};
    std::uint64_t messages{}, bytes{};
  };
  std::map<std::uint16_t, Row> rows;
  std::map<std::uint16_t, std::string> types;
  Visitor visitor;
  visitor.schema = [&](const Schema& schema) { types[schema.id] = schema.name; };
  visitor.channel = [&](const Channel& channel) { rows[channel.id].channel = channel; };
  visitor.message = [&](const Channel& channel, const Message& message) {
    ++rows[channel.id].messages;
    rows[channel.id].bytes += message.data.size();
  };
  visitor.metadata = [&](const std::string& name, const Text& entries) {
    for (const auto& [key, value] : entries)
      std::printf("%s %s: %s\n", name.c_str(), key.c_str(), value.c_str());
  };
  const auto report = read_file(file, visitor);
  if (!report) return report_error(report.error().text);
  std::printf("%llu messages in %llu chunks, %.3f s, %llu bytes\n",
              static_cast<unsigned long long>(report->messages),
              static_cast<unsigned long long>(report->chunks), in_seconds(report->last - report->first),
              static_cast<unsigned long long>(report->bytes));
  std::printf("%10s %12s  %-44s %s\n", "messages", "bytes", "topic", "type");
  for (const auto& [id, row] : rows)
    std::printf("%10llu %12llu  %-44s %s\n", static_cast<unsigned long long>(row.messages),
                static_cast<unsigned long long>(row.bytes), row.channel.topic.c_str(),
                row.channel.schema != 0 ? types[row.channel.schema].c_str() : "-");
  return judged(file, *report);
}

/// Decodes messages by the schemas in the file.
class Contents {
 public:
  void add(const Schema& schema) {
    if (schema.encoding != "omgidl") return;
    const auto types = parse_idl(schema.text);
    if (!types) return;  // Only its size is shown.
    if (const auto it = types->find(schema.name); it != types->end()) types_[schema.id] = it->second;
  }
  std::string text(const Channel& channel, ByteSpan data) const {
    const auto type = types_.find(channel.schema);
    if (channel.encoding != "cdr" || type == types_.end()) return std::to_string(data.size()) + " bytes";
    const auto json = cdr_to_json(*type->second, data);
    return json ? *json : std::to_string(data.size()) + " bytes: " + json.error().text;
  }

 private:
  std::map<std::uint16_t, std::shared_ptr<const IdlType>> types_{};
};

int cat(const std::string& file, const std::string& topic, bool who) {
  Contents contents;
  Visitor visitor;
  visitor.schema = [&](const Schema& schema) { contents.add(schema); };
  visitor.message = [&](const Channel& channel, const Message& message) {
    if (channel.topic.find(topic) == std::string::npos) return;
    std::printf("%.6f %s", in_seconds(message.time), channel.topic.c_str());
    for (const auto& [key, value] : channel.metadata)
      if (who && !value.empty()) std::printf(" %s=%s", key.c_str(), value.c_str());
    std::printf(" %s\n", contents.text(channel, message.data).c_str());
  };
  const auto report = read_file(file, visitor);
  return report ? judged(file, *report) : report_error(report.error().text);
}

/// Copies the readable content of one file; channels and schemas get new numbers.
class Copy {
 public:
  explicit Copy(McapWriter& writer) : writer_(writer) {}
  Result<ReadReport> add(const std::string& file) {
    std::map<std::uint16_t, std::uint16_t> schemas, channels;
    Visitor visitor;
    visitor.schema = [&](const Schema& s) {
      auto& own = schemas_[s.name + "\n" + s.encoding + "\n" + s.text];
      if (own == 0) own = writer_.add_schema(s.name, s.encoding, s.text);
      schemas[s.id] = own;
    };
    visitor.channel = [&](const Channel& c) {
      Channel key = c;
      key.id = 0;
      key.schema = c.schema == 0 ? std::uint16_t{0} : schemas[c.schema];
      const auto [it, fresh] =
          channels_.try_emplace({key.schema, key.topic, key.encoding, key.metadata}, std::uint16_t{0});
      if (fresh) it->second = writer_.add_channel(key.schema, key.topic, key.encoding, key.metadata);
      channels[c.id] = it->second;
    };
    visitor.message = [&](const Channel& c, const Message& m) {
      keep(writer_.write(channels[c.id], m.time, m.data));
    };
    visitor.metadata = [&](const std::string& name, const Text& entries) {
      keep(writer_.add_metadata(name, entries));
    };
    auto report = read_file(file, visitor);
    if (!report) return report;
    if (!state_) return state_.error();
    return report;
  }

 private:
  void keep(const Result<void>& result) {
    if (state_ && !result) state_ = result;
  }

  McapWriter& writer_;
  Result<void> state_{};
  std::map<std::string, std::uint16_t> schemas_{};
  std::map<std::tuple<std::uint16_t, std::string, std::string, Text>, std::uint16_t> channels_{};
};

int recover(const std::vector<std::string>& files) {
  auto output = open_file(files.back(), true);
  if (!output) return report_error(output.error().text);
  McapWriter writer(**output, {1 << 20, true, "adit recording recover"});
  Copy copy(writer);
  for (std::size_t i = 0; i + 1 < files.size(); ++i) {
    const auto report = copy.add(files[i]);
    if (!report) return report_error(report.error().text);
    (void)judged(files[i], *report);
  }
  if (const auto closed = writer.close(); !closed) return report_error(closed.error().text);
  std::printf("%llu messages in %s\n", static_cast<unsigned long long>(writer.messages()),
              files.back().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Looks into MCAP recordings, whole or torn off.", "recording"};
  app.require_subcommand(1);
  app.footer(kFooter);
  app.set_version_flag("--version", ADIT_VERSION);
  std::string file, topic;
  std::vector<std::string> files;
  auto* info_command = app.add_subcommand("info", "topics, types, counts");
  info_command->add_option("file", file, "the recording")->required();
  auto* cat_command = app.add_subcommand("cat", "one line a message");
  cat_command->add_option("file", file, "the recording")->required();
  cat_command->add_option("--topic", topic, "only topics that contain this");
  bool who = false;
  cat_command->add_flag("--who", who, "who sent it to whom, as well");
  auto* recover_command = app.add_subcommand("recover", "all that can be read, into a new file");
  recover_command->add_option("files", files, "one or several recordings, then the new file")
      ->required()
      ->expected(2, 10000);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  if (*info_command) return info(file);
  if (*cat_command) return cat(file, topic, who);
  for (std::size_t i = 0; i + 1 < files.size(); ++i)
    if (files[i] == files.back())
      return report_error("the new file must be another than those that are read");
  (void)recover_command;
  return recover(files);
}
