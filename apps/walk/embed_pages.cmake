# Write a .cpp that holds the files of the viewer: cmake -DFILES=... -DOUTPUT=... -P embed_pages.cmake
# Each byte becomes a number: string literals have limits, and files may hold any byte.
set(table "")
set(arrays "")
set(count 0)
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  get_filename_component(ending ${file} LAST_EXT)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  if(ending STREQUAL ".html")
    set(type "text/html; charset=utf-8")
  elseif(ending STREQUAL ".js")
    set(type "text/javascript; charset=utf-8")
  elseif(ending STREQUAL ".css")
    set(type "text/css; charset=utf-8")
  elseif(ending STREQUAL ".svg")
    set(type "image/svg+xml")
  elseif(ending STREQUAL ".webmanifest")
    set(type "application/manifest+json")
  else()
    message(FATAL_ERROR "${file}: of no type that a page has")
  endif()
  if(name STREQUAL "index.html")
    set(path "/")
  else()
    set(path "/page/${name}")
  endif()
  string(APPEND arrays "constexpr unsigned char kPage${count}[] = {${bytes}};\n")
  string(APPEND table "        {\"${path}\", \"${type}\", text(kPage${count}, sizeof kPage${count})},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"apps/walk/pages.h\"

namespace lightwalk {
namespace {

${arrays}
std::string_view text(const unsigned char* bytes, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

const std::vector<WebAsset>& viewer_pages() {
    static const std::vector<WebAsset> pages{
${table}    };
    return pages;
}

}  // namespace lightwalk
")
