#pragma once
// Surfaces of a room that between them have a material of nearly every kind: with sources, a scene
// in which light takes every way.

namespace lightwalk::test {

inline constexpr const char* kEveryMaterial = R"(
void plastic paint 0 0 5 .5 .4 .3 .05 0
paint polygon floor 0 0 12 -4 -4 0 4 -4 0 4 4 0 -4 4 0
void plastic gloss 0 0 5 .3 .4 .5 .2 .1
gloss polygon wall 0 0 12 -4 4 0 4 4 0 4 4 4 -4 4 4
void metal steel 0 0 5 .6 .6 .7 .9 0
void mixfunc mixed 4 steel paint .3 . 0 0
mixed polygon wall2 0 0 12 -4 -4 0 -4 -4 4 4 -4 4 4 -4 0
void mirror mir 0 0 3 .8 .7 .6
mir polygon m 0 0 12 4 -3 0 4 3 0 4 3 4 4 -3 4
void glass pane 0 0 3 .9 .8 .7
pane polygon g 0 0 12 -4 -4 4 4 -4 4 4 4 4 -4 4 4
void trans veil 0 0 7 .6 .6 .5 .05 0 .6 .4
veil polygon curtain 0 0 12 -4 -1 .2 -4 1 .2 -4 1 3 -4 -1 3
void dielectric crystal 0 0 5 .9 .8 .9 1.5 0
crystal sphere ball 0 0 4 -1 -1 .6 .5
)";

}  // namespace lightwalk::test
