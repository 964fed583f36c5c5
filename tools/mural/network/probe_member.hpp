// The process that `mural doctor --network` starts on a host: reports arriving datagrams. Controlled by lines of JSON
// on standard input, with replies on standard output, independent of the measured network path.
//
//   first line  {"secret", "addresses": the doctor's, "port": TCP, "group", "interface", "survey"}
//            →  {"version", "reached", "own", "why", "port", "troubles", "facts"}
//   {"do": "seen"}                                    → {"seen": [{"way", "size", "count"}]}: probes since the last request
//   {"do": "send", "to", "port", "sizes", "copies"}   → {"troubles"}: sends probes of all kinds to the doctor
//   {"do": "join", "control"}                         → {"joined", "why"}: joins the doctor's group and reads its stream
//   {"do": "leave"}                                   → {"bytes", "socketDropped", "refused", "queueDropped"}
//   It ends with the end of standard input, and after ten minutes of silence.
#pragma once

namespace mural::cli {

int networkMemberCommand();

} // namespace mural::cli
