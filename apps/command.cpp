#include "command.hpp"

#include <exception>
#include <new>

#include "isotherm/base/error.hpp"
#include "isotherm/base/output_group.hpp"
#include "isotherm/base/text_writer.hpp"
#include "json_file.hpp"
#include "unsigned_flag.hpp"

namespace isotherm::apps {
namespace {

// More than any machine has; what is beyond its cores plays no part.
constexpr double kMostThreads = 1024;

}  // namespace

Verb one_of(CLI::App* parent, std::vector<Verb> subcommands) {
  parent->require_subcommand(1);
  return {parent, [subcommands = std::move(subcommands)] {
            for (const auto& subcommand : subcommands) {
              if (subcommand.parser->parsed()) return subcommand.run();
            }
            return static_cast<int>(kUsage);
          }};
}

void add_common_flags(CLI::App& verb, CommonFlags& flags) {
  const auto group = [](CLI::Option* option) { option->group("Common"); };
  group(flags.outputs.add(verb, "--json", flags.json, "write the result as JSON (- for stdout)",
                          {".json"}));
  group(verb.add_option("--config", flags.config, "take option values from a JSON file")
            ->type_name("FILE"));
  group(verb.add_flag("--dump-config", flags.dump_config,
                      "print the options in force as JSON and stop"));
  group(verb.add_flag("--strict", flags.strict, "treat every repair of the input as an error"));
  group(add_unsigned(verb, "--seed", flags.seed, "seed of all random choices")
            ->capture_default_str());
  group(add_number(verb, "--threads", flags.threads,
                   "threads to use, at most one a core; 0: all cores", closed(0, kMostThreads))
            ->default_str("0"));
  group(verb.add_flag("-q,--quiet", flags.quiet, "say nothing on stderr but errors"));
  group(verb.add_flag("-v,--verbose", flags.verbose, "say more on stderr"));
  group(verb.add_flag("--no-progress", flags.no_progress, "draw no progress line"));
}

int run_with_outputs(const CommonFlags& flags, const std::function<int()>& run) {
  flags.outputs.check();
  OutputGroup group;
  const int code = run();
  group.commit();
  return code;
}

Ending run_to_end(const Verb& verb) {
  try {
    return {verb.run(), ""};
  } catch (const InvalidArgument& error) {
    return {kUsage, error.what()};
  } catch (const ParseError& error) {
    return {kBadInput, error.what()};
  } catch (const FileError& error) {
    return {kBadInput, error.what()};
  } catch (const Cancelled&) {
    return {kInterrupted, ""};
  } catch (const std::bad_alloc&) {
    return {kFailure, "out of memory"};
  } catch (const std::exception& error) {
    return {kFailure, error.what()};
  }
}

Json read_config(const CommonFlags& flags) {
  if (flags.config.empty()) return Json::object();
  auto config = read_json(flags.config);
  if (!config.is_object()) throw ParseError({flags.config, 0, 0}, "", "must hold a JSON object");
  return config;
}

void write_text(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void write_json(const std::string& path, const Json& json) {
  if (path.empty()) return;
  write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace isotherm::apps
