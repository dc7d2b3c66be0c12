// Small sound inputs that touch most of what each reader knows.
#include <memory>
#include <string>
#include <vector>

#include "core/bsdf/bsdf.h"
#include "io/bsdf/bsdf_file.h"
#include "io/formats/decode.h"
#include "io/net/walk_frame.h"
#include "io/picture/encode_picture.h"
#include "io/picture/image_encoder.h"
#include "io/picture/picture.h"
#include "io/picture/picture_data.h"
#include "io/scene/binary_models.h"
#include "io/scene/frozen_scene.h"
#include "io/scene/scene_reader.h"
#include "tests/fuzz/targets.h"
#include "tests/io/bsdf/bsdf_text.h"
#include "tests/io/gltf/small_gltf.h"
#include "tests/io/picture/small_images.h"
#include "tests/test_scene.h"

namespace lightwalk::test {
namespace {

const std::string kScene = R"rad(# a room with a bit of everything
void plastic white 0 0 5 .7 .7 .7 .05 .02
void light bulb 0 0 3 100 90 80
void glow sky 0 0 4 1 1 1 0
void glass pane 0 0 3 .9 .9 .9
void mirror silver 0 0 3 .8 .8 .8
void spectrum reddish 0 0 7 400 700 .1 .2 .4 .6 .8
reddish WGMDfunc coated 13 inherit .1 .05 .05 void .5 0 0 void 1 0 0 . 0 9 .2 .2 .2 .1 .1 .1 0 0 0
void dielectric ball 0 0 5 .9 .9 .9 1.5 0
void brightfunc grain 2 if(noise3(Px,Py,Pz),.8,.5) . 0 0
grain plastic wood 0 0 5 .5 .3 .1 0 0
void texfunc bumps 4 .1*noise3x(Px,Py,Pz) 0 0 . 0 1 3
bumps metal brass 0 0 5 .8 .6 .2 .9 .1
void mixfunc dots 4 wood brass frac(Px)-.5 . 0 0
inherit alias floor_mat white
void plastic2 brushed 4 1 0 0 . 0 6 .5 .5 .5 .1 .05 .2
bulb sphere lamp 0 0 4 0 0 3 .1
sky source up 0 0 4 0 0 1 180
floor_mat polygon floor 0 0 12 -2 -2 0 2 -2 0 2 2 0 -2 2 0
white ring plate 0 0 8 0 1 1 0 -1 0 0 .5
dots cylinder post 0 0 7 1 1 0 1 1 2 .1
brushed cone hat 0 0 8 1 1 2 1 1 2.5 .3 0
ball sphere crystal 0 0 4 0 .5 1 .3
pane polygon window 0 0 12 -1 -1 1 1 -1 1 1 -1 2 -1 -1 2
coated polygon plate2 0 0 12 1 1.9 .2 2 1.9 .2 2 1.9 1.2 1 1.9 1.2
silver polygon glassy 0 0 12 -2 1.9 .2 -1 1.9 .2 -1 1.9 1.2 -2 1.9 1.2
!genbox white box .5 .4 .3 | xform -t .2 .3 0 -rz 30
!genbox white step .1 .1 .1 | xform -n a -a 3 -t .2 0 0
!genworm white w "cos(t)" "sin(t)" t .1 5
!gensky 6 21 12 +s
)rad";

const std::string kIes =
    "IESNA:LM-63-2002\n[LAMP] xenon\nTILT=INCLUDE\n2\n3\n0 45 90\n1 .9 .8\n1 1000 2 3 2 1 2 -.3 "
    "-.3 .2\n.9 1 60\n0 45 180\n0 90\n10 20 30 40 50 60\n";
const std::string kEulumdat =
    "maker\n1\n4\n4\n90\n3\n45\nr\nn\nn\nf\nd\n600\n600\n90\n400\n300\n0\n0\n0\n0\n100\n80\n1\n0\n1"
    "\n1\n"
    "LED\n2000\n3000\n80\n20\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n0\n90\n180\n270\n0\n45\n90\n100\n90\n80"
    "\n110\n95\n85\n";
const std::string kLampTable =
    "# lamps\n/cool[- ]white/ .373 .385 .85\n/\\<fluor/ (cool white)\n%x.*y% .3 .3 1\n";

const std::string kObject =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .2\nv .5 .2 0\nvn 0 0 1\nvn .1 0 2\nvt 0 0\nvt "
    "1 .5\n"
    "o thing\ng part\nf 1 2 3 4 5\nusemtl red\nf 1/1/1 2/2/2 -1/1/1\nf 1//1 2//2 \\\n3//1 4//1\n";
const std::string kObjectMaterials =
    "newmtl a\nKd .8 .7 .6\nKs .1 .1 .1\nNs 100\nillum 2\nnewmtl b\nKd .2 .2 .2\nKs .7 .5 .3\nNs "
    "20\nd "
    ".5\nnewmtl c\nd .1\nTf 1 .9 .8\nNi 1.5\nillum 4\nnewmtl d\nKe 3 2 1\nmap_Kd -s 1 1 1 "
    "a.hdr\nmap_d a.png\n";

const std::string kFunctions = R"({ comments { nest } }
a = if(Px - .5, noise3(Px,Py,Pz)*k, sqrt(max(0, Dz)));
k : 3*PI/2;
b = select(2, a, fac(5), frac(7.25)) + A1*A2/arg(3);
fac(n) : if(n-1.5, n*fac(n-1), 1);
c = turbulence(Px/4, Py/4, Pz/4, .25)^2 - fnoise3(Px,Py,Pz) + min(1,2,Rdot);
f(x,y) = g(x) + g(y); g(x) = 1/(1 + x*x) - Exp(-x) + atan2(x, 1);
)";

const std::string kData1 = "# comment\n2\n0 1 3\n0 0 4 1 2 4 8\n1 2 3 4\n5 6 7 8\n9 10 11 12\n";
const std::string kFont = "32 0\n65 4 40 30 200 30 200 220 40 220\n66 3 20 20 240 20 130 240\n";

const std::string kRad = R"(# a house
scene= walls.rad 'the roof.rad' "!xform -rz 5 door.rad"   # and more
materials= wood.rad
illum= panes.rad
mkillum= -ab 1
ZONE= Interior -1 4.5 0 4 0 3
QUAL= Med
DET High
VARIABILITY= low
INDIRECT= 2
PENUMBRAS= T
EXPOSURE= +1.5
RESOLUTION= 640 480 1.25
UP= -Y
view= entrance -vp 1 1 1.6 \
    -vd 1 0 0
view= xyZl -vh 5
view= -vf side.vf
render= -av 1 1 1
AMBFILE= a.amb
oconv= -i base.oct -r 1000
)";

const std::string kViewRequest =
    R"({"type":"view","id":7,"view":{"type":"v","position":[1,2,1.6],"direction":[0,1,0],)"
    R"("up":[0,0,1],"horizontal":60,"vertical":40.5,"fore":0.1,"aft":9,"shift":0.25,"lift":-0.5},)"
    R"("width":640,"height":480,"moving":true,"walk":false})";
const std::string kDisplayRequest =
    R"({"type":"display","mode":"tone","exposure":{"auto":false,"ev":-2.5},"human":true,)"
    R"("scale":{"low":0.1,"high":3000,"log":true}})";
const std::string kProbesRequest =
    R"({"type":"probes","probes":[{"id":1,"position":[1,2,3],"normal":[0,0,2]},)"
    R"({"id":2,"position":[-1,0,0],"normal":[1,0,0]}]})";
const std::string kIsoluxRequest = R"({"type":"isolux","id":7,"position":[1,2,0.5],"height":0.75})";

/// Big-endian integer of n bytes.
std::string integer(std::int64_t value, int n) {
    std::string bytes;
    for (int i = n - 1; i >= 0; --i) bytes += static_cast<char>((value >> (8 * i)) & 255);
    return bytes;
}
std::string text(const std::string& s) {
    return s + '\0';
}
/// The number `quarters`/4 as a portable float: mantissa over 2^31 - 1 and exponent.
std::string portable(int quarters) {
    return integer(std::int64_t{quarters} << 20, 4) + integer(9, 1);
}

std::string object(int type, int modifier, const std::string& name,
                   const std::vector<int>& quarters) {
    std::string bytes = integer(type, 1) + integer(modifier, 4) + text(name) + integer(0, 2) +
                        integer(static_cast<int>(quarters.size()), 2);
    for (const int q : quarters) bytes += portable(q);
    return bytes;
}

std::string type_table() {
    return text("polygon") + text("sphere") + text("plastic") + text("light") + text("");
}

std::string frozen_octree() {
    std::string bytes =
        "#?RADIANCE\noconv -f room.rad\nFORMAT=Radiance_octree\n\n" + integer(287, 2);
    bytes += text("-2") + text("-2") + text("-2") + text("4") + text("") + integer(4, 4);
    bytes += integer(2, 1) + integer(1, 1) + integer(2, 4) + integer(1, 4) + integer(3, 4);
    for (int i = 0; i < 7; ++i) bytes += integer(0, 1);
    bytes += type_table();
    bytes += object(2, -1, "white", {2, 2, 2, 0, 0});
    bytes += object(0, 0, "floor", {-4, -4, 0, 4, -4, 0, 4, 4, 0, -4, 4, 0});
    bytes += object(3, -1, "bulb", {40, 40, 40});
    bytes += object(1, 2, "lamp", {0, 0, 4, 1});
    return bytes + integer(-1, 1);
}

std::string mesh() {
    std::string bytes = "#?RADIANCE\nobj2mesh\nFORMAT=Radiance_tmesh\n\n" + integer(323, 2);
    bytes += text("0") + text("0") + text("0") + text("1");
    for (const int uv : {0, 4, 0, 4}) bytes += portable(uv);
    bytes += integer(1, 1) + integer(1, 4) + integer(0, 4);
    bytes += type_table() + object(2, -1, "white", {2, 2, 2, 0, 0}) + integer(-1, 1);
    bytes += integer(1, 4) + integer(7, 1) + integer(3, 2);
    for (int i = 0; i < 9; ++i) bytes += integer(0x10000000LL * (i * 5 % 13), 4);
    for (int i = 0; i < 3; ++i) bytes += integer(8, 4);
    for (int i = 0; i < 6; ++i) bytes += integer(0x20000000LL * (i + 1), 4);
    bytes += integer(1, 2) + integer(0, 1) + integer(1, 1) + integer(2, 1);
    return bytes + integer(1, 2) + integer(0, 2) + integer(0, 2) + integer(0, 2);
}

Picture gradient() {
    Picture picture{24, 5, {}};
    for (int i = 0; i < picture.width * picture.height; ++i) {
        picture.pixels.push_back({0.1f * static_cast<float>(i % 7), i < 40 ? 0.5f : 2.0f, 1.0f});
    }
    return picture;
}

SmallGltf gltf_seed() {
    SmallGltf gltf;
    gltf.nodes =
        R"({"children":[1,2],"rotation":[0,0.7,0,0.7],"scale":[1,2,1]},{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]},)"
        R"({"mesh":1,"extensions":{"KHR_lights_punctual":{"light":0}}})";
    gltf.meshes +=
        R"(,{"primitives":[{"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":4},"indices":3,"material":1}]})";
    gltf.materials =
        R"({"name":"m","alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.2,0.5],"metallicFactor":0.2},"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.5}}},)"
        R"({"emissiveFactor":[1,1,0.5],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":100}}})";
    gltf.more_accessors =
        R"(,{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":3,"byteOffset":2,"componentType":5123},"values":{"bufferView":1}}})";
    gltf.more =
        R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":100,"color":[1,0.5,0.5],"spot":{"outerConeAngle":0.5}}]}})";
    return gltf;
}

std::string jpeg_seed() {
    std::vector<std::uint8_t> pixels(16 * 8 * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(7 * i);
    ImageRequest request;
    request.format = "jpeg";
    request.width = 16;
    request.height = 8;
    request.pixels = pixels.data();
    return encode_image(request);
}

/// What makes use of every kind of library file, of some that are missing, too.
const std::string kUsers = R"rad(
void brightfunc shade 2 if(a,1,.5) f.cal 0 0
shade plastic shaded 0 0 5 .5 .5 .5 0 0
void brightfunc lost 2 1 lost.cal 0 0
lost plastic unseen 0 0 5 .5 .5 .5 0 0
void brightdata table 5 noneg d.dat . Px Py 0 0
table plastic measured 0 0 5 .5 .5 .5 0 0
void colorpict image 7 noneg noneg noneg p.hdr . Px Py 0 0
image plastic painted 0 0 5 .5 .5 .5 0 0
void brighttext sign 3 f.fnt A B 0 11 -1 -2 0 .5 0 0 0 0 .5 1 .2
sign plastic lettered 0 0 5 .5 .5 .5 0 0
void BSDF woven 6 0 m.xml 0 0 1 . 0 0
void aBSDF slats 5 t.xml 0 0 1 . 0 0
woven sphere b1 0 0 4 1 -1 1 .3
slats sphere b2 0 0 4 .4 -1.5 .6 .3
shaded sphere s1 0 0 4 -1 -1 1 .3
unseen sphere s2 0 0 4 9 9 9 .3
measured polygon p1 0 0 9 -2 -2 .1 2 -2 .1 2 2 .1
painted polygon p2 0 0 12 -2 1 0 2 1 0 2 1 3 -2 1 3
lettered polygon p3 0 0 12 -1 -2 0 1 -2 0 1 -2 .5 -1 -2 .5
painted cup c1 0 0 8 0 0 .1 0 0 .5 .2 .3
measured bubble b1 0 0 4 1 -1 1 .2
shaded tube t1 0 0 7 -1 0 0 -1 0 1 .1
shaded ring flat 0 0 8 0 0 0 0 0 1 .2 .2
void instance tree 5 tree.oct -t .5 -1 .5 0 0
void mesh stone 5 stone.rtm -t -.5 -1 .5 0 0
)rad";

/// A scene with all of that, frozen.
std::string frozen_scene() {
    MemoryResources files;
    files.functions["f.cal"] = kFunctions;
    files.tables["d.dat"] = std::make_shared<const DataArray>(decode_data(kData1, "d.dat"));
    files.pictures["p.hdr"] =
        std::make_shared<const PictureData>(decode_picture(encode_hdr(gradient(), {}), "p.hdr"));
    for (const auto& [name, text] :
         {std::pair("m.xml", matrix_text("1 2 3 .4 .5 .6 7 8 9")),
          std::pair("t.xml", tree_text("{ {1} {2} {3} {4} {.5} {6} {7} { 1 2 3 4 5 6 7 8 } }"))})
        files.bsdfs[name] =
            std::make_shared<const Bsdf>(std::make_shared<const BsdfData>(decode_bsdf(text, name)));
    files.fonts["f.fnt"] = std::make_shared<const Font>(decode_font(kFont, "f.fnt"));
    files.octrees["tree.oct"] = decode_octree(frozen_octree(), "tree.oct").model;
    files.meshes["stone.rtm"] = std::make_shared<const MeshModel>(decode_mesh(mesh(), "stone.rtm"));
    FreezingResources library(files);
    Silence silence;
    SceneReadOptions options;
    options.library = LibraryPath(std::vector<std::string>{});
    const Scene scene(parse_scene(kScene + kUsers, "room.rad", options, silence), modifier_factory,
                      library, silence);
    const std::vector<ManifestFile> manifest{{"/lost.cal"}, {"/room.rad", true, 9, 9, 9}};
    return frozen_scene_bytes(scene, library, manifest);
}

/// An OpenEXR file of two layers of 5 x 4 pixels.
std::string small_layers() {
    const auto row = [](int y, float* values) {
        for (int i = 0; i < 5 * 6; ++i) values[i] = static_cast<float>(i % 6 + y);
    };
    return encode_exr(5, 4, {"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}, row, {{"LIGHT_GROUP= c"}});
}

std::string small_frame() {
    WalkFrameHeader header;
    header.width = 30;
    header.height = 20;
    return encode_walk_frame(
        header, std::vector<WalkFramePiece>{{0, 0, 16, 20, PieceCodec::jpeg, "some bytes"},
                                            {16, 0, 14, 20, PieceCodec::png, "others"},
                                            {0, 0, 30, 20, PieceCodec::depth, ""}});
}

}  // namespace

std::span<const std::string> seeds_of(FuzzTarget target) {
    static const std::vector<std::string> scenes{kScene};
    static const std::vector<std::string> octrees{frozen_octree()};
    static const std::vector<std::string> functions{kFunctions};
    static const std::vector<std::string> pictures{
        encode_hdr(gradient(), {{"VIEW= -vtv -vp 0 0 0", "EXPOSURE=2"}}),
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nPIXASPECT=2\n\n+X 2 -Y 3\n" +
            std::string("abcd\1\1\1\2abcdabcdabcd")};
    static const std::vector<std::string> data{kData1, kFont, mesh()};
    if (target == read_scene_text) return scenes;
    if (target == read_octree) return octrees;
    if (target == read_function_file) return functions;
    static const std::vector<std::string> requests{kViewRequest, kDisplayRequest, kProbesRequest,
                                                   kIsoluxRequest};
    static const std::vector<std::string> bsdfs{
        matrix_text("1 2 3\n.4,.5,.6\n7 8 9"), matrix_text("1 2 3 4 5 6 7 8 9", "Rows"),
        tree_text("{ {1} {2} {3} {4} {.5} {6} {7} { 1 2 3 4 5 6 7 8 } }"),
        tree_text("{ {.1} {.2} {3} {4} {5} {6} {7} {8} {9} {0} {1} {2} {3} {4} {5} {.6} }", 4)};
    if (target == read_bsdf_file) return bsdfs;
    if (target == read_picture) return pictures;
    if (target == read_walk_request) return requests;
    static const std::vector<std::string> rads{kRad, "scene= a.rad\nview= -vf a.vf\n"};
    if (target == read_rad_file) return rads;
    static const std::vector<std::string> frozen{frozen_scene()};
    static const std::vector<std::string> luminaires{kIes, kLampTable, kEulumdat};
    if (target == read_luminaire) return luminaires;
    static const std::vector<std::string> objects{kObject, kObjectMaterials};
    if (target == read_wavefront) return objects;
    static const std::vector<std::string> gltfs{gltf_seed().binary(), gltf_seed().json("a.bin")};
    if (target == read_gltf_file) return gltfs;
    static const std::vector<std::string> images{small_png(), small_tiff(), jpeg_seed(),
                                                 small_tga(), small_bmp(),  small_webp(),
                                                 lossy_webp()};
    if (target == read_image) return images;
    static const std::vector<std::string> frames{small_frame()};
    if (target == read_walk_frame) return frames;
    static const std::vector<std::string> layers{small_layers()};
    if (target == read_layers) return layers;
    if (target == read_frozen || target == read_resealed) return frozen;
    return data;
}

}  // namespace lightwalk::test
