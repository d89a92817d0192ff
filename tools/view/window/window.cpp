#include "tools/view/window/window.hpp"

#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "base/error.hpp"

namespace tandem::view {
namespace {

Window& window_of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

[[noreturn]] void fail(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw Error(fmt::format("tandem view: {}{}{}", what, reason != nullptr ? ": " : "", reason != nullptr ? reason : ""));
}

/// Dear ImGui's own callbacks, which it installs later, pass everything on to these.
void install_callbacks(GLFWwindow* window) {
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    if (action != GLFW_RELEASE && !ImGui::GetIO().WantTextInput) window_of(w).events().key(key, modifiers);
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
    glm::dvec2 position;
    glfwGetCursorPos(w, &position.x, &position.y);
    if (action == GLFW_RELEASE || !ImGui::GetIO().WantCaptureMouse)
      window_of(w).events().button(button, action == GLFW_PRESS, modifiers, position);
  });
  glfwSetCursorPosCallback(window,
                           [](GLFWwindow* w, double x, double y) { window_of(w).events().move(glm::dvec2(x, y)); });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double steps) {
    if (!ImGui::GetIO().WantCaptureMouse) window_of(w).events().wheel(steps);
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
    if (count > 0) window_of(w).events().drop(files[0]);
  });
}

}  // namespace

Window::Window(glm::ivec2 size, const std::string& title, Events events) : events_(std::move(events)), title_(title) {
  if (glfwInit() != GLFW_TRUE) fail("no window can be opened");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
  window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    const std::string text = reason != nullptr ? reason : "unknown reason";
    glfwTerminate();
    throw Error(fmt::format("tandem view: no window with OpenGL 3.0 can be opened: {}", text));
  }
  glfwSetWindowUserPointer(window_, this);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(0);  // begin_frame waits for news, not for the screen
  install_callbacks(window_);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no file in the user's folder
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 130");
  glGenTextures(1, &texture_);
}

Window::~Window() {
  glDeleteTextures(1, &texture_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::begin_frame(double wait_seconds) {
  glfwWaitEventsTimeout(wait_seconds);
  if (glfwWindowShouldClose(window_) != 0) {
    glfwHideWindow(window_);  // a driver may still be compiling for long
    return false;
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  return true;
}

void Window::end_frame(glm::ivec2 picture_offset, glm::ivec2 picture_size) {
  const ImVec2 first(static_cast<float>(picture_offset.x), static_cast<float>(picture_offset.y));
  const ImVec2 last(first.x + static_cast<float>(picture_size.x), first.y + static_cast<float>(picture_size.y));
  // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui's name of a texture
  ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t{texture_}), first, last);
  ImGui::Render();
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glViewport(0, 0, width, height);
  glClearColor(0.1f, 0.1f, 0.1f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window_);
}

void Window::show(const Picture& picture) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  // Pixels are to be seen as they are.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(picture.width), static_cast<GLsizei>(picture.height), 0,
               GL_RGBA, GL_UNSIGNED_BYTE, picture.bytes.data());
}

void Window::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::wake() { glfwPostEmptyEvent(); }

glm::ivec2 Window::size() const {
  glm::ivec2 size;
  glfwGetWindowSize(window_, &size.x, &size.y);
  return size;
}

bool Window::is_pressed(int key) const {
  return glfwGetKey(window_, key) == GLFW_PRESS && !ImGui::GetIO().WantTextInput;
}

}  // namespace tandem::view
