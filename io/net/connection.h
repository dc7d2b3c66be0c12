#pragma once
// The base class of the web server's connections.
#include <set>
#include <string>

namespace lightwalk {

/// A connection of the server; it is in the server's list as long as it exists. For the server's
/// thread only.
class Connection {
  public:
    using List = std::set<Connection*>;
    explicit Connection(List& list) : list_(list) { list_.insert(this); }
    virtual ~Connection() { list_.erase(this); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Close the connection, because the server ends.
    virtual void stop(const std::string& reason) = 0;

  private:
    List& list_;
};

}  // namespace lightwalk
