#include "apps/commands.h"

namespace lightwalk {
namespace {

constexpr const char* kProgramHelp =
    R"(lightwalk: physically based pictures of Radiance scenes.

  lightwalk render OPTIONS SCENE...   a picture of a view          (like rpict)
  lightwalk animate OPTIONS SCENE...  the frames of a walk
  lightwalk walk OPTIONS SCENE...     walk through a scene in a browser
  lightwalk trace OPTIONS SCENE...    radiance along single rays   (like rtrace)
  lightwalk freeze SCENE... -o FILE   a scene in one file, for a quick start
  lightwalk info SCENE...             what a scene holds
  lightwalk help COMMAND              how to use one of them

SCENE is one octree (.oct), one frozen scene (.lwz), or Radiance scene files in order; "-" is standard input, which
render and info also read when no scene is named. Library files are looked for along RAYPATH, then in the library that comes with Lightwalk.

A first picture, of a room with a window:
  lightwalk render -vp 2 1.6 0.5 -vd 0 0 1 -vu 0 1 0 -vh 60 -vv 45 -o room.png room.rad

Exit status: 0 success, 1 bad input (the message begins with file:line), 2 a command line that was not understood,
130 ended by Ctrl-C. Nothing is ever half-written.
)";

constexpr const char* kRenderHelp =
    R"(lightwalk render OPTIONS SCENE...

Compute a picture. Options are those of Radiance's rpict; a word @FILE or $NAME in place of an option stands for the
words in the file or environment variable. A switch like -dv toggles; -dv+ and -dv- set it. `-defaults` lists every
option with its value.

Output
  -o FILE            .hdr .pic: Radiance picture; .exr: float; .png .jpg: for the screen. Without -o a Radiance
                     picture goes to standard output. A file of that name is replaced when the new one is whole.
  -pXYZ              a Radiance picture holds CIE XYZ, Y in cd/m2; -pRGB: radiance (the default)
  -z FILE            distances along the pixels' rays [m]: raw floats from the top, or .exr; 1e10: nothing there
  --exposure auto|EV for .png and .jpg: average brightness, or a fixed number of stops
  --tone curve|linear  for .png and .jpg: compress what is brighter than middle grey, so that windows and lamps
                     keep their drawing (default), or cut off at white
  --stats FILE.json  seconds to read, build and render, rays by kind, rays per second, memory
  -t SECONDS         report progress in lines; on a terminal there is a progress bar unless --quiet
  -e FILE            append messages to FILE

View
  -vtv|l|c|h|a|s     perspective, parallel, cylindrical, hemispherical, angular, stereographic
  -vp X Y Z          view point            -vd X Y Z   direction        -vu X Y Z   up
  -vh H  -vv V       sizes in degrees (parallel: metres)
  -vo D  -va D       fore and aft clipping distance
  -vs S  -vl L       shift right and lift up, in picture sizes
  -vf FILE           read from a view file or a picture
  -x N  -y N         largest width and height [pixels]; -pa A: pixel aspect, 0: exactly -x by -y

Sampling
  -ps N              trace every Nth pixel, and those between where neighbours differ; 1: every pixel
  -pt T              how much they may differ, as a share
  -pj J              jitter of a ray within its pixel, 0 to 1
  --samples N        N rays in every pixel, drawn from a Gaussian of .6 pixels as of pfilt -r .6, and averaged: edges
                     without steps, less noise (default 1; -ps is then 1 and -pj does not count; -z tells the
                     distance along the ray nearest to the pixel's centre)
  -pd D  -pm M       lens diameter, for depth of field; share of the frame time the shutter is open (with -S)
  --seed N           other random numbers; the same seed gives the same bytes (with -ab: see --deterministic)
  -n N               threads; default: all. --executor serial|threads|tbb: what runs them
  -S N               a picture for each view line on standard input, numbered from N; -o f%03d.hdr names them

Light (the most used; see rpict(1) for the rest)
  -av R G B          constant ambient radiance
  -dt -dc -dj -ds -dr -dp -dv    direct light: threshold, certainty, jitter, subdivision, redirections, pretest, visibility
  -ab N              bounces of indirect light; -aa -ar -ad -as: accuracy, resolution, divisions, super-samples
  --ambient-lights N  where the rays of indirect light arrive, N light samples (default 2), chosen by what they may
                     bring, stand for all: the same mean, little more noise; 0: all are tested
  -ae -ai MODIFIER   leave out, or take only, surfaces of this modifier; -aE -aI FILE: of those in the file
  -af FILE           keep ambient values in a file; several runs may share it, also Radiance's
  --prepass auto|off   fill the ambient cache by a coarse picture first (default: auto)
  --deterministic    the same bytes with any number of threads also with -ab: the cache is filled in rounds
  -ss -st -lr -lw                specular samples and threshold, limits of reflections and weight
  -i                 irradiance instead of radiance

Many processes, on one machine or many: mpirun -n RANKS lightwalk render ...
  --variant ranks    one thread a rank; one rank is the master, with -ab another one the ambient master
  --variant hybrid   ranks of threads (-n N each), rank 0 traces beside being the master. Default: hybrid where ranks
                     have several threads (-n, or what mpirun binds them to) or are too few to spare any
  --scene-from WHO   shared (default): on one machine rank 0 reads the scene, and all share its memory; on several as
                     each: every rank reads its own copy (a frozen scene is in memory once a machine anyway);
                     rank0: rank 0 reads it for all, where the others do not see its files
  --block auto|N     side of the blocks that are handed out: follows what they take, or N pixels
  --stride auto|N    consecutive blocks lie N apart (auto: the number of workers); 1: one after the other
  --masters auto|N   masters in all: those below rank 0 serve a group of workers each
  --ambient-batch N  a worker sends its ambient values by N (default 16) and gets the others'; 0: none are exchanged
  --timeline FILE.json  what every thread did when: opens in ui.perfetto.dev. --stats has the sums, by rank

  --checkpoint FILE  keep finished blocks in FILE, at most two seconds after they are traced; with -ab, ambient
                     values in FILE-ambient, unless -af or --deterministic does what that is for
  --resume           with --checkpoint: a run that was killed goes on, with any number of ranks and threads
  --allow-commands   run commands in scene files that Lightwalk does not replace by its own generators
  --stale            take a frozen scene whose files have changed since it was frozen
  --quiet            no progress, no warnings; -w- alone: no warnings
)";

constexpr const char* kAnimateHelp =
    R"(lightwalk animate OPTIONS SCENE...

Compute the frames of a walk. Options are those of `lightwalk render`, but for -S and the checkpoint; what a frame has
in common with those before it is not traced again.

  -o FILE            name of the frames' files, with %d or %04d for their numbers, from 1: frame%04d.hdr .exr .png .jpg.
                     Pictures for the screen are all exposed as the first one (--exposure EV: fixed).
                     FILE.mp4: a film, by the program ffmpeg where it is installed
  --fps N            of a film: frames a second, default 25

The walk, one of
  --path FILE        a file of views, one a line: "VIEW= -vp X Y Z -vd X Y Z ..."; what a line leaves out is as in the line
                     before. A number before it is its time in seconds, otherwise a second passes. Each line is a
                     frame; with --frames N, N of them are spread over the time, on a smooth path through the views
  --rotate DEGREES   a turn to the right, about the view's up vector, by so much in all. Needs --frames
  --walk MOVE        turn, forward, backward, left or right, from the view of the command line. Needs --frames
  --step PERCENT     of a move: share of the field of view, default 1. A turn's step is that share of -vh; a step
                     sideways shifts what the middle of the first picture shows by that share of the picture's width;
                     steps forward and backward are as long
  --frames N         number of frames

Reuse. Every traced pixel leaves a point: where its light came from, and how much. Later frames take points instead of
rays wherever these are true.
  --reuse WHAT       off: every pixel of every frame is traced; cloud: a point lasts while each frame uses it;
                     supersaturated (default): others stay, too, until they leave the view or grow old
  --cloud-age N      supersaturated: frames that a point outlives unused, default 25
  --cloud-limit N    points are at most N times the pixels, default 4
  --check WHICH      of which pixels a ray tells what is there, so that no other thing's point shows: all (default),
                     rotating (all but those in the midst of a surface that the last frame has shown; of these a third,
                     another one in each frame), edges (where points are missing or jump in depth, and the picture's
                     rim), none
  --drop WHICH       where no ray tells: hidden: points far behind most of those around them are dropped; lonely: those
                     far from all around them; both (default), none
  --look WHERE       back (default): a pixel takes the nearest point of what its ray meets; forward: only a point that
                     falls onto it
  --near PIXELS      back: a point so near will do (1)
  --reach PIXELS     back: where the points around agree, one so near will do (1.5, which is the most)
  --contrast PERCENT back: they agree when the darkest and the brightest differ by no more (10)
  --specular-tolerance PERCENT  how far a colour that depends on the view may be off before it is traced anew (10)
  --audit PERCENT    of the reused pixels are traced all the same, a quarter of these twice; --stats has the errors, and
                     how much two rays of a pixel differ. Default 1
  --audit-limit PERCENT  when so many more of them are off by a tenth than two rays differ by as much, reuse is
                     tightened (ages, angles, distances) until it holds, then slowly loosened. Default 10, 0: never
  --budget MS        milliseconds a frame: the worst uncached are traced first, what does not fit is filled from around
                     it, and traced in later frames. Default 0: all are traced
  --refine PERCENT   when a frame has the view of the frame before, that share of its pixels is made better (10): those
                     filled, then those reused, oldest first, then, with further rays, those at steps of brightness
  --projectors N     of many ranks so many at most keep points (32); the others trace what is missing
)";

constexpr const char* kWalkHelp =
    R"(lightwalk walk OPTIONS SCENE...

Walk through a scene in a browser: prints the address to open. Options are those of `lightwalk render` and those on
reuse of `lightwalk animate`, but for what is about files of pictures. When the scene's files change it is read again,
and the walk goes on from where it stood; what is wrong with them stands in the page.

  -vf FILE           a view for the page's list, named as the file; repeatable. The first is where the walk begins, and its
                     height above the ground is that of the eyes
  --port N           default 8080; 0: any that is free
  --bind ADDRESS     default 127.0.0.1: this machine alone. Anything else demands the token in the printed address
  --clients N        browsers at once, default 8: the first drives, others watch
  --fps N            frames a second while moving, default 30: a frame's time goes to its worst pixels, the others are
                     filled from around them and traced later
  --max-size WxH     of pictures, default 1920x1200; larger windows show them enlarged
  --check WHICH      as of animate, default rotating: a frame shows for a moment only, and each pixel is checked every
                     few frames; after a quarter of a frame's time the points alone tell the rest
  --ambient WHEN     rest (default): with -ab, indirect light comes when the view rests; always, off. The page may change it
  --edge-samples N   rays that a pixel at an edge gets when the view rests, default 8; 1: the picture of `lightwalk render`
)";

constexpr const char* kTraceHelp =
    R"(lightwalk trace OPTIONS SCENE...

Trace rays from standard input, one record a ray on standard output, in order. A ray is six numbers: origin and
direction. Options are those of Radiance's rtrace, as are the defaults (-defaults lists them); @FILE, $NAME and
switches work as in `lightwalk render`.

  -h                 no header (a bare switch toggles, and it is on)
  -fXY               formats of input and output: a text, f float, d double, and for output c RGBE; -fX: both
  -oLETTERS          fields of a record, default v:
                       o origin   d direction   v radiance   V radiance times coefficient   w W weights
                       l distance of what is seen   L first distance   p first point   c mesh coordinates
                       n shading normal   N geometric normal   s surface   m modifier   M material
                       r mirrored part   x the rest   R X their distances   ~ a tilde
  -I                 irradiance: rays are points and the normals there
  -i                 irradiance at the first surface seen
  -ld                a direction's length limits its ray
  -x N  -y N         picture size: flush after N rays, stop after N * N; a resolution line goes first
                       t T the fields after it, for every ray that is traced: children first, a tab for each
                           generation, -n 1. T also tells shadow rays that reach their light source unhindered
  -te -ti MODIFIER   with t or T: leave out, or take only, rays that meet this modifier; -tE -tI FILE: those in the file
  -pRGB -pXYZ -pY -pA   colours as RGB, XYZ, luminance, mean
  -n N               threads; default: all. Without -ab the output does not depend on it
  --ambient-lights N  as in `lightwalk render`
  --seed N           other random numbers; equal rays of one run draw different ones
  --stats FILE.json  time and rays
  -e FILE            append messages to FILE
  --allow-commands, --stale, --quiet, --executor   as in `lightwalk render`

A zero direction flushes the output. The input ends at its end, or at a word that is no number.

  echo "0 0 1  0 0 -1" | lightwalk trace -h -ovp -av .1 .1 .1 room.rad
)";

constexpr const char* kFreezeHelp =
    R"(lightwalk freeze SCENE... -o FILE.lwz

Write all that a run needs of a scene to one file: surfaces, materials, instances and meshes, and of the library the
function files, data, pictures and fonts that the scene uses. Every command takes such a file in place of the scene,
and makes the same pictures of it, bit for bit. It is mapped, not read: a run begins sooner, and processes on one
machine share its pages. Only the tree that rays search is built anew.

  lightwalk freeze building.rad furniture.rad sky.rad -o building.lwz
  lightwalk render -vf entrance.vf -o entrance.hdr building.lwz

The file knows what it was made from. Where a file has changed since, is missing, or has come to stand before another
one in the library, the run ends and names it; --stale takes the scene as it was frozen. Commands that were run
(--allow-commands) and standard input are not looked at again. Damaged files are refused: each part has a checksum. A
file belongs to the version of Lightwalk that wrote it.

  -o FILE            the frozen scene; a file of that name is replaced when the new one is whole
  -n N               threads; default: all
  --allow-commands   run commands in scene files that Lightwalk does not replace by its own generators
  --quiet            no warnings
)";

constexpr const char* kInfoHelp =
    R"(lightwalk info SCENE...

Say what a scene holds: primitives by type, bounds, light sources with the virtual ones that mirrors and prisms make,
instances, memory, and what Lightwalk does not support, with the first place of each. Exit status 1 when the scene
cannot be rendered; what could be found out is printed all the same.

  -dr N              redirections of virtual sources, default 1
  --allow-commands   run commands in scene files that Lightwalk does not replace by its own generators
)";

}  // namespace

const char* help_text(const std::string& command) {
    if (command == "render") return kRenderHelp;
    if (command == "animate") return kAnimateHelp;
    if (command == "walk") return kWalkHelp;
    if (command == "trace") return kTraceHelp;
    if (command == "freeze") return kFreezeHelp;
    if (command == "info") return kInfoHelp;
    return kProgramHelp;
}

}  // namespace lightwalk
