// A picture of a scene, by the installed library: picture SCENE PICTURE
#include <lightwalk/renderer.h>
#include <cstdio>
#include <exception>

int main(int, char** words) {
    try {
        lightwalk::RendererOptions options;
        options.light.ambient_value = {.1f, .1f, .1f};
        lightwalk::Renderer renderer(lightwalk::LoadedScene({words[1]}), options);
        lightwalk::PictureTask task;
        task.view.position = {0, -4, 1};
        task.width = 80;
        task.height = 60;
        const auto picture = renderer.finish(renderer.start(task));
        lightwalk::save_picture(words[2], *picture);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
