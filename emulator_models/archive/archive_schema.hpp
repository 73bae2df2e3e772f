// The tables and views of an archive file. `event` holds the records as they are (soft_plc/event_record.hpp says what
// code and v0 to v4 mean); the views put them into words for the sqlite3 shell.
#pragma once

#include <cstdint>

namespace emulator_models::archive {

/// "ltPA": what tells an archive from any other SQLite file.
inline constexpr std::int32_t application_id = 0x6C745041;
inline constexpr std::int32_t schema_version = 2;

inline constexpr const char* schema_sql = R"sql(
CREATE TABLE power_up (id INTEGER PRIMARY KEY, wall_clock_ns INTEGER NOT NULL);
CREATE TABLE signal (power_up INTEGER NOT NULL, number INTEGER NOT NULL, name TEXT NOT NULL,
                     PRIMARY KEY (power_up, number)) WITHOUT ROWID;
CREATE TABLE program (power_up INTEGER NOT NULL, cycle INTEGER NOT NULL, file TEXT NOT NULL,
                      PRIMARY KEY (power_up, cycle)) WITHOUT ROWID;
CREATE TABLE event (id INTEGER PRIMARY KEY, power_up INTEGER NOT NULL, time_ns INTEGER NOT NULL, kind INTEGER NOT NULL,
                    cycle INTEGER NOT NULL, code INTEGER NOT NULL, scan_number INTEGER NOT NULL,
                    v0 INTEGER NOT NULL, v1 INTEGER NOT NULL, v2 INTEGER NOT NULL, v3 INTEGER NOT NULL,
                    v4 INTEGER NOT NULL);
CREATE VIEW timed_event AS
  SELECT event.*, round(time_ns / 1e9, 6) AS seconds,
         strftime('%Y-%m-%d %H:%M:%f', (wall_clock_ns + time_ns) / 1e9, 'unixepoch') AS wall_clock
  FROM event LEFT JOIN power_up ON power_up.id = event.power_up;
CREATE VIEW scans AS
  SELECT id, power_up, seconds, wall_clock, cycle, scan_number AS last_scan, v0 AS scans_count,
         v1 / 1e6 AS shortest_ms, v2 / 1e6 AS longest_ms,
         CASE WHEN v0 > 0 THEN round(v3 / 1e6 / v0, 6) END AS mean_ms, v4 AS overruns
  FROM timed_event WHERE kind = 1;
CREATE VIEW overruns AS
  SELECT id, power_up, seconds, wall_clock, cycle, scan_number, CASE WHEN v0 >= 0 THEN v0 / 1e6 END AS scan_ms
  FROM timed_event WHERE kind = 2;
CREATE VIEW faults AS
  SELECT id, e.power_up, seconds, wall_clock, e.cycle, scan_number,
         CASE code WHEN 1 THEN 'watchdog' WHEN 2 THEN 'overrun' WHEN 3 THEN 'program failed' WHEN 4 THEN 'other cycle' WHEN 5 THEN 'inputs stale'
                   ELSE 'code ' || code END AS fault,
         CASE v0 WHEN 0 THEN 'system analysis' WHEN 1 THEN 'clear fault' WHEN 2 THEN 'initialise'
                 WHEN 3 THEN 'write safe outputs' WHEN 4 THEN 'read inputs' WHEN 5 THEN 'read from cycles'
                 WHEN 6 THEN 'execute' WHEN 7 THEN 'write to cycles' WHEN 8 THEN 'write outputs'
                 WHEN 9 THEN 'refresh output image' WHEN 10 THEN 'wait' WHEN 11 THEN 'enter fault'
                 ELSE 'action ' || v0 END AS phase,
         v1 / 1e6 AS scan_ms, CASE WHEN v2 > 0 THEN coalesce(file || ':', '') || v2 || ':' || v3 END AS place
  FROM timed_event e LEFT JOIN program p ON p.power_up = e.power_up AND p.cycle = e.cycle WHERE kind = 3;
CREATE VIEW port_writes AS
  SELECT id, power_up, seconds, wall_clock, cycle AS port, code AS area, v0 AS address,
         CASE WHEN v3 > 0 THEN v3 - 1 END AS bit, v1 AS bytes, printf('%016x', v2) AS first_bytes
  FROM timed_event WHERE kind = 6;
CREATE VIEW signal_changes AS
  SELECT e.id, e.power_up, seconds, wall_clock, cycle, scan_number, coalesce(name, 'signal ' || code) AS signal,
         v0 AS before, v1 AS after
  FROM timed_event e LEFT JOIN signal s ON s.power_up = e.power_up AND s.number = e.code WHERE kind = 7;
CREATE VIEW history AS
  SELECT e.id, e.power_up, seconds, wall_clock, cycle, scan_number,
         CASE kind WHEN 1 THEN 'scans' WHEN 2 THEN 'overrun' WHEN 3 THEN 'fault' WHEN 4 THEN 'fault cleared'
                   WHEN 5 THEN 'mode' WHEN 6 THEN 'port write' WHEN 7 THEN 'signal' WHEN 8 THEN 'records lost'
                   ELSE 'kind ' || kind END AS event,
         CASE kind WHEN 1 THEN v0 || ' scans, longest ' || v2 / 1e6 || ' ms, overruns ' || v4
                   WHEN 2 THEN CASE WHEN v0 >= 0 THEN v0 / 1e6 || ' ms' ELSE 'in STOP' END
                   WHEN 3 THEN (SELECT fault || ' in ' || phase || coalesce(' at ' || place, '') FROM faults f
                                WHERE f.id = e.id)
                   WHEN 4 THEN 'code ' || code
                   WHEN 5 THEN CASE code WHEN 0 THEN 'STOP' WHEN 1 THEN 'RUN' ELSE code END
                   WHEN 6 THEN v1 || ' bytes at ' || v0
                   WHEN 7 THEN coalesce(s.name, 'signal ' || code) || ': ' || v0 || ' -> ' || v1
                   WHEN 8 THEN v0 || ' records' END AS what
  FROM timed_event e LEFT JOIN signal s ON kind = 7 AND s.power_up = e.power_up AND s.number = e.code;
)sql";

}  // namespace emulator_models::archive
