#pragma once
// What the sockets of a web server have in common.
#include <set>
#include <string>

namespace lightwalk {

/// A socket that the server has, in its list while it lives. On the server's thread.
class Connection {
  public:
    using List = std::set<Connection*>;
    explicit Connection(List& list) : list_(list) { list_.insert(this); }
    virtual ~Connection() { list_.erase(this); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// The server ends.
    virtual void stop(const std::string& reason) = 0;

  private:
    List& list_;
};

}  // namespace lightwalk
