// The process that `mural doctor` starts on a host, with --network and --nodes. It reports arriving datagrams. Lines of
// JSON on standard input control it, and replies go to standard output. Both are independent of the measured network
// path.
//
//   First line: {"secret", "addresses": the doctor's, "port": TCP, "group", "interface", "survey"}.
//   Reply to it: {"version", "reached", "own", "why", "port", "troubles", "facts"}.
//   Request {"do": "seen"} returns {"seen": [{"path", "size", "count"}]}: the probes since the last request.
//   Request {"do": "send", "to", "port", "sizes", "copies"} sends probes of all kinds to the doctor.
//   Reply to it: {"troubles"}.
//   Request {"do": "join", "control"} joins the doctor's group and reads its stream.
//   Reply to it: {"joined", "why"}.
//   Request {"do": "clock"} returns {"ns"}: the time of day.
//   Request {"do": "inspect", "displays", "folder"} returns {"host"}: HostFacts.
//   Request {"do": "listen", "family", "token", "ms"} opens a RateListener.
//   Reply to it: {"port", "problem"}.
//   Request {"do": "rate"} returns {"bytesPerS", "problem"} of that listener.
//   Request {"do": "leave"} returns {"bytes", "socketDropped", "refused", "queueDropped"}.
//
// The process ends at the end of standard input, or after ten minutes of silence.
#pragma once

namespace mural::cli {

int networkMemberCommand();

} // namespace mural::cli
