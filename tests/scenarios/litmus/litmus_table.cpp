#include "tests/scenarios/litmus/litmus_table.hpp"

namespace litmus {
namespace {

using enum Verdict;

// Verdicts worked out by hand from C++20 [intro.races], [atomics.order] and [atomics.fences]. The names of the tests are those of
// "A Tutorial Introduction to the ARM and POWER Relaxed Memory Models" (Maranget, Sarkar, Sewell).
constexpr Variant table[] = {
    // SB, store buffering: each stores and then misses what the other has stored.
    {"SB/relaxed", "x=1.rlx ; y.rlx || y=1.rlx ; x.rlx", "0 0", allowed},
    {"SB/release-acquire", "x=1.rel ; y.acq || y=1.rel ; x.acq", "0 0", allowed},
    {"SB/seq-cst", "x=1.sc ; y.sc || y=1.sc ; x.sc", "0 0", forbidden},
    {"SB/seq-cst-stores", "x=1.sc ; y.rlx || y=1.sc ; x.rlx", "0 0", allowed},
    {"SB/seq-cst-loads", "x=1.rlx ; y.sc || y=1.rlx ; x.sc", "0 0", allowed},
    {"SB/seq-cst-one-side", "x=1.sc ; y.sc || y=1.rel ; x.acq", "0 0", allowed},
    {"SB/one-release-store", "x=1.sc ; y.sc || y=1.rel ; x.sc", "0 0", allowed},
    {"SB/seq-cst-fences", "x=1.rlx ; fence.sc ; y.rlx || y=1.rlx ; fence.sc ; x.rlx", "0 0", forbidden},
    {"SB/one-seq-cst-fence", "x=1.rlx ; fence.sc ; y.rlx || y=1.rlx ; x.rlx", "0 0", allowed},
    {"SB/acq-rel-fences", "x=1.rlx ; fence.ar ; y.rlx || y=1.rlx ; fence.ar ; x.rlx", "0 0", allowed},
    {"SB/fence-against-seq-cst", "x=1.rlx ; fence.sc ; y.rlx || y=1.sc ; x.sc", "0 0", forbidden},
    {"SB/fence-against-seq-cst-load", "x=1.rlx ; fence.sc ; y.rlx || y=1.rlx ; x.sc", "0 0", allowed},
    {"SB/updates-for-stores", "x+=1.ar ; y.acq || y+=1.ar ; x.acq", "* 0 * 0", allowed},
    {"SB/seq-cst-updates-for-stores", "x+=1.sc ; y.sc || y+=1.sc ; x.sc", "* 0 * 0", forbidden},
    {"SB/updates-for-loads", "x=1.rel ; y+=0.ar || y=1.rel ; x+=0.ar", "0 0", allowed},

    // MP, message passing: the flag is seen, the message is not.
    {"MP/relaxed", "x=1.rlx ; y=1.rlx || y.rlx ; x.rlx", "1 0", allowed},
    {"MP/release-acquire", "x=1.rlx ; y=1.rel || y.acq ; x.rlx", "1 0", forbidden},
    {"MP/release-alone", "x=1.rlx ; y=1.rel || y.rlx ; x.rlx", "1 0", allowed},
    {"MP/acquire-alone", "x=1.rlx ; y=1.rlx || y.acq ; x.rlx", "1 0", allowed},
    {"MP/seq-cst", "x=1.sc ; y=1.sc || y.sc ; x.sc", "1 0", forbidden},
    {"MP/seq-cst-flag", "x=1.rlx ; y=1.sc || y.sc ; x.rlx", "1 0", forbidden},
    {"MP/seq-cst-stores", "x=1.sc ; y=1.sc || y.rlx ; x.rlx", "1 0", allowed},
    {"MP/fences", "x=1.rlx ; fence.rel ; y=1.rlx || y.rlx ; fence.acq ; x.rlx", "1 0", forbidden},
    {"MP/release-fence-acquire-load", "x=1.rlx ; fence.rel ; y=1.rlx || y.acq ; x.rlx", "1 0", forbidden},
    {"MP/release-store-acquire-fence", "x=1.rlx ; y=1.rel || y.rlx ; fence.acq ; x.rlx", "1 0", forbidden},
    {"MP/release-fence-alone", "x=1.rlx ; fence.rel ; y=1.rlx || y.rlx ; x.rlx", "1 0", allowed},
    {"MP/acquire-fence-alone", "x=1.rlx ; y=1.rlx || y.rlx ; fence.acq ; x.rlx", "1 0", allowed},
    {"MP/fences-that-face-away", "x=1.rlx ; fence.acq ; y=1.rlx || y.rlx ; fence.rel ; x.rlx", "1 0",
     allowed},
    {"MP/seq-cst-fences", "x=1.rlx ; fence.sc ; y=1.rlx || y.rlx ; fence.sc ; x.rlx", "1 0", forbidden},
    {"MP/through-an-update", "x=1.rlx ; y=1.rel || y+=1.rlx || y.acq ; x.rlx", "1 2 0", forbidden},
    {"MP/through-a-store-of-another", "x=1.rlx ; y=1.rel || y.rlx ; y=2.rlx || y.acq ; x.rlx", "1 2 0",
     allowed},
    {"MP/through-a-later-store", "x=1.rlx ; y=1.rel ; y=2.rlx || y.acq ; x.rlx", "2 0", allowed},
    {"MP/acquire-by-exchange", "x=1.rlx ; y=1.rel || y?1:2.acq ; x.rlx", "1 0", forbidden},
    {"MP/failed-exchange-releases-only", "x=1.rlx ; y=1.rel || y?5:2.rel ; x.rlx", "1 0", allowed},
    {"MP/failed-exchange-acquires", "x=1.rlx ; y=1.rel || y?5:2.ar ; x.rlx", "1 0", forbidden},

    // LB, load buffering: each sees what the other stores only afterwards.
    {"LB/relaxed", "x.rlx ; y=1.rlx || y.rlx ; x=1.rlx", "1 1", allowed_by_load_buffering},
    {"LB/release-acquire", "x.acq ; y=1.rel || y.acq ; x=1.rel", "1 1", forbidden},
    {"LB/one-side", "x.acq ; y=1.rel || y.rlx ; x=1.rlx", "1 1", allowed_by_load_buffering},
    {"LB/acquire-alone", "x.acq ; y=1.rlx || y.acq ; x=1.rlx", "1 1", allowed_by_load_buffering},
    {"LB/release-alone", "x.rlx ; y=1.rel || y.rlx ; x=1.rel", "1 1", allowed_by_load_buffering},
    {"LB/fences", "x.rlx ; fence.ar ; y=1.rlx || y.rlx ; fence.ar ; x=1.rlx", "1 1", forbidden},
    {"LB/seq-cst", "x.sc ; y=1.sc || y.sc ; x=1.sc", "1 1", forbidden},
    {"LB/seq-cst-stores", "x.rlx ; y=1.sc || y.rlx ; x=1.sc", "1 1", allowed_by_load_buffering},

    // IRIW, independent reads of independent writes: two readers see two stores in different orders.
    {"IRIW/relaxed", "x=1.rlx || y=1.rlx || x.rlx ; y.rlx || y.rlx ; x.rlx", "1 0 1 0", allowed},
    {"IRIW/release-acquire", "x=1.rel || y=1.rel || x.acq ; y.acq || y.acq ; x.acq", "1 0 1 0", allowed},
    {"IRIW/seq-cst", "x=1.sc || y=1.sc || x.sc ; y.sc || y.sc ; x.sc", "1 0 1 0", forbidden},
    {"IRIW/seq-cst-loads", "x=1.rlx || y=1.rlx || x.sc ; y.sc || y.sc ; x.sc", "1 0 1 0", forbidden},
    {"IRIW/seq-cst-stores", "x=1.sc || y=1.sc || x.acq ; y.acq || y.acq ; x.acq", "1 0 1 0", allowed},
    {"IRIW/one-seq-cst-reader", "x=1.sc || y=1.sc || x.sc ; y.sc || y.acq ; x.acq", "1 0 1 0", allowed},
    {"IRIW/seq-cst-second-loads", "x=1.sc || y=1.sc || x.acq ; y.sc || y.acq ; x.sc", "1 0 1 0", allowed},
    {"IRIW/seq-cst-fences", "x=1.rlx || y=1.rlx || x.rlx ; fence.sc ; y.rlx || y.rlx ; fence.sc ; x.rlx",
     "1 0 1 0", forbidden},
    {"IRIW/acquire-fences", "x=1.rlx || y=1.rlx || x.rlx ; fence.acq ; y.rlx || y.rlx ; fence.acq ; x.rlx",
     "1 0 1 0", allowed},

    // WRC, write to read causality: who passes a message on has seen it, the last in the row has not.
    {"WRC/relaxed", "x=1.rlx || x.rlx ; y=1.rlx || y.rlx ; x.rlx", "1 1 0", allowed},
    {"WRC/release-acquire", "x=1.rel || x.acq ; y=1.rel || y.acq ; x.acq", "1 1 0", forbidden},
    {"WRC/second-handover-alone", "x=1.rlx || x.rlx ; y=1.rel || y.acq ; x.rlx", "1 1 0", forbidden},
    {"WRC/first-handover-alone", "x=1.rel || x.acq ; y=1.rlx || y.rlx ; x.rlx", "1 1 0", allowed},
    {"WRC/last-load-relaxed", "x=1.rel || x.acq ; y=1.rel || y.rlx ; x.acq", "1 1 0", allowed},
    {"WRC/seq-cst", "x=1.sc || x.sc ; y=1.sc || y.sc ; x.sc", "1 1 0", forbidden},
    {"WRC/fences", "x=1.rlx || x.rlx ; fence.rel ; y=1.rlx || y.rlx ; fence.acq ; x.rlx", "1 1 0", forbidden},

    // 2+2W: both words keep what was stored to them first.
    {"2+2W/relaxed", "x=1.rlx ; y=2.rlx || y=1.rlx ; x=2.rlx", "| 1 1", allowed},
    {"2+2W/release", "x=1.rel ; y=2.rel || y=1.rel ; x=2.rel", "| 1 1", allowed},
    {"2+2W/seq-cst", "x=1.sc ; y=2.sc || y=1.sc ; x=2.sc", "| 1 1", forbidden},
    {"2+2W/seq-cst-one-side", "x=1.sc ; y=2.sc || y=1.rlx ; x=2.rlx", "| 1 1", allowed},
    {"2+2W/seq-cst-fences", "x=1.rlx ; fence.sc ; y=2.rlx || y=1.rlx ; fence.sc ; x=2.rlx", "| 1 1",
     forbidden},
    {"2+2W/acq-rel-fences", "x=1.rlx ; fence.ar ; y=2.rlx || y=1.rlx ; fence.ar ; x=2.rlx", "| 1 1", allowed},

    // R: a store comes late, and the load after it early.
    {"R/relaxed", "x=1.rlx ; y=1.rlx || y=2.rlx ; x.rlx", "0 | * 2", allowed},
    {"R/release-acquire", "x=1.rel ; y=1.rel || y=2.rel ; x.acq", "0 | * 2", allowed},
    {"R/seq-cst", "x=1.sc ; y=1.sc || y=2.sc ; x.sc", "0 | * 2", forbidden},
    {"R/seq-cst-fences", "x=1.rlx ; fence.sc ; y=1.rlx || y=2.rlx ; fence.sc ; x.rlx", "0 | * 2", forbidden},
    {"R/one-seq-cst-fence", "x=1.rlx ; fence.rel ; y=1.rlx || y=2.rlx ; fence.sc ; x.rlx", "0 | * 2",
     allowed},

    // S: a store that comes after a message has been seen takes its place before one that the message followed.
    {"S/relaxed", "x=2.rlx ; y=1.rlx || y.rlx ; x=1.rlx", "1 | 2", allowed},
    {"S/release-acquire", "x=2.rlx ; y=1.rel || y.acq ; x=1.rlx", "1 | 2", forbidden},
    {"S/release-alone", "x=2.rlx ; y=1.rel || y.rlx ; x=1.rlx", "1 | 2", allowed},
    {"S/acquire-alone", "x=2.rlx ; y=1.rlx || y.acq ; x=1.rlx", "1 | 2", allowed},
    {"S/seq-cst", "x=2.sc ; y=1.sc || y.sc ; x=1.sc", "1 | 2", forbidden},
    {"S/fences", "x=2.rlx ; fence.rel ; y=1.rlx || y.rlx ; fence.acq ; x=1.rlx", "1 | 2", forbidden},

    // Coherence: what holds for one word by itself, however weak the orders.
    {"CoRR/relaxed", "x=1.rlx || x.rlx ; x.rlx", "1 0", forbidden},
    {"CoRR/seq-cst", "x=1.sc || x.sc ; x.sc", "1 0", forbidden},
    {"CoRR/two-readers", "x=1.rlx || x=2.rlx || x.rlx ; x.rlx || x.rlx ; x.rlx", "1 2 2 1", forbidden},
    {"CoWW/relaxed", "x=1.rlx ; x=2.rlx", "| 1", forbidden},
    {"CoWW/release", "x=1.rel ; x=2.rel", "| 1", forbidden},
    {"CoRW/own-later-store", "x.rlx ; x=1.rlx", "1", forbidden},
    {"CoRW/relaxed", "x.rlx ; x=1.rlx || x=2.rlx", "2 | 2", forbidden},
    {"CoRW/seq-cst", "x.sc ; x=1.sc || x=2.sc", "2 | 2", forbidden},
    {"CoWR/relaxed", "x=1.rlx ; x.rlx || x=2.rlx", "2 | 1", forbidden},
    {"CoWR/what-was-there", "x=1.rlx ; x.rlx || x=2.rlx", "0", forbidden},
    {"CoWR/release-acquire", "x=1.rel ; x.acq || x=2.rel", "2 | 1", forbidden},
    {"atomic/two-updates", "x+=1.rlx || x+=1.rlx", "| 1", forbidden},
    {"atomic/two-exchanges", "x?0:1.rlx || x?0:2.rlx", "0 0", forbidden},

    // ISA2: MP over a third task.
    {"ISA2/release-acquire", "x=1.rlx ; y=1.rel || y.acq ; z=1.rel || z.acq ; x.rlx", "1 1 0", forbidden},
    {"ISA2/second-handover-relaxed", "x=1.rlx ; y=1.rel || y.acq ; z=1.rlx || z.rlx ; x.rlx", "1 1 0",
     allowed},

    // Z6.U: C++11 forbade it, and Power's usual compilation shows it; C++20 allows it (P0668R5).
    {"Z6.U/mixed", "x=1.sc ; y=1.rel || y+=1.sc ; y.rlx || y=3.sc ; x.sc", "1 3 0", allowed},
    {"Z6.U/seq-cst", "x=1.sc ; y=1.sc || y+=1.sc ; y.sc || y=3.sc ; x.sc", "1 3 0", forbidden},
};

}  // namespace

std::span<const Variant> variants() noexcept { return table; }

}  // namespace litmus
