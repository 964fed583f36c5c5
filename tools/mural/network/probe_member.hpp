// The process that `mural doctor --network` starts on a host: it tells what arrives there. Spoken to by lines of JSON on
// standard input, answers on standard output, so that what is looked at is not what the answers come by.
//
//   first line  {"secret", "addresses": the doctor's, "port": TCP, "group", "interface", "survey"}
//            →  {"version", "reached", "own", "why", "port", "troubles", "facts"}
//   {"do": "seen"}                                    → {"seen": [{"way", "size", "count"}]}: probes since the last question
//   {"do": "send", "to", "port", "sizes", "copies"}   → {"troubles"}: probes of all ways to the doctor
//   {"do": "join", "control"}                         → {"joined", "why"}: becomes a member of the doctor's group, and reads
//   {"do": "leave"}                                   → {"bytes", "socketDropped", "refused", "queueDropped"}
//   the end of standard input ends it; so do ten minutes without a word
#pragma once

namespace mural::cli {

int networkMemberCommand();

} // namespace mural::cli
