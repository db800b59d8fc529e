console.log("x")
import "./page.css";
